// SPDX-License-Identifier: MIT
#include "reports/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "foundation/text.hpp"

namespace tribench {
namespace {

bool starts_code_point(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

std::string escaped(std::string_view cell) {
  std::string text;
  for (const char c : cell) {
    if (c == '|') text += '\\';
    // Markdown lets HTML through: a name or a reason from outside must not become a tag. Other
    // control characters than a line's end show nothing and break what reads the page.
    if (c == '<') {
      text += "&lt;";
    } else if (c >= 0 && c < ' ') {
      text += ' ';
    } else {
      text += c;
    }
  }
  return text;
}

std::string padded(const std::string& text, std::size_t width, Align align) {
  const std::string space(width - display_width(text), ' ');
  return align == Align::left ? text + space : space + text;
}

}  // namespace

std::size_t display_width(std::string_view utf8) {
  return static_cast<std::size_t>(std::count_if(utf8.begin(), utf8.end(), starts_code_point));
}

std::string shortened(std::string_view utf8, std::size_t width) {
  if (display_width(utf8) <= width) return std::string(utf8);
  std::size_t bytes = 0;
  for (std::size_t points = 0; bytes < utf8.size(); ++bytes) {
    if (starts_code_point(utf8[bytes]) && ++points > width - 3) break;
  }
  return std::string(utf8.substr(0, bytes)) + "...";
}

std::string markdown_code(std::string_view text) {
  std::size_t longest = 0;  // run of backticks
  for (std::size_t i = 0, run = 0; i < text.size(); ++i) {
    run = text[i] == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  const std::string fence(longest + 1, '`');
  // A blank within each fence is not shown.
  const char* space = text.starts_with('`') || text.ends_with('`') ? " " : "";
  return fmt::format("{0}{1}{2}{1}{0}", fence, space, text);
}

std::string without_tags(std::string_view page) {
  constexpr std::string_view kOpeners = "/!?";  // of a tag, beside letters
  std::string text;
  for (std::size_t i = 0; i < page.size(); ++i) {
    const char next = i + 1 < page.size() ? page[i + 1] : ' ';
    const bool opens = (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z') ||
                       kOpeners.find(next) != std::string_view::npos;
    if (page[i] == '<' && opens) {
      text += "&lt;";
    } else {
      text += page[i];
    }
  }
  return lines_without_control_characters(text);
}

void MarkdownTable::add(std::vector<std::string> cells) {
  for (std::string& cell : cells) cell = escaped(cell);
  rows_.push_back(std::move(cells));
}

std::string MarkdownTable::text() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    std::size_t width = std::max<std::size_t>(3, display_width(headings_[i].text));
    for (const auto& row : rows_) width = std::max(width, display_width(row[i]));
    widths.push_back(width);
  }
  std::string text = "|";
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    text += fmt::format(" {} |", padded(headings_[i].text, widths[i], headings_[i].align));
  }
  text += "\n|";
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    const bool right = headings_[i].align == Align::right;
    text += fmt::format(" {}{} |", std::string(widths[i] - (right ? 1 : 0), '-'), right ? ":" : "");
  }
  text += '\n';
  for (const auto& row : rows_) {
    text += '|';
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format(" {} |", padded(row[i], widths[i], headings_[i].align));
    }
    text += '\n';
  }
  return text;
}

}  // namespace tribench
