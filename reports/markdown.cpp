// SPDX-License-Identifier: MIT
#include "reports/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "foundation/text.hpp"

namespace tribench {
namespace {

bool starts_code_point(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

// Which bytes of a line stand in code spans, where CommonMark decodes no `&lt;` and takes no tag
// for one. None at all where that hangs on the reader: an unpaired backtick in a cell, or one
// behind a backslash, pairs with another than the one that was meant.
struct LineCode {
  std::vector<bool> at;
  bool is_certain = true;
};

LineCode code_of(std::string_view line) {
  LineCode code{std::vector<bool>(line.size(), false), true};
  const auto uncertain = [&] { return LineCode{std::vector<bool>(line.size(), false), false}; };
  if (line.find("\\\\") != std::string_view::npos || line.find("\\`") != std::string_view::npos) {
    return uncertain();
  }
  const auto run_at = [&](std::size_t i) { return line.find_first_not_of('`', i) - i; };
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] != '`') continue;
    const std::size_t fence = std::min(run_at(i), line.size() - i);
    std::size_t end = i + fence;  // of the code
    std::size_t run = 0;
    for (; end < line.size(); end += std::max<std::size_t>(run, 1)) {
      if (line[end] == '|' && line[end - 1] != '\\') break;  // where a cell ends, code does
      run = line[end] == '`' ? std::min(run_at(end), line.size() - end) : 0;
      if (run == fence) break;
    }
    if (run != fence) return uncertain();
    std::fill(code.at.begin() + static_cast<std::ptrdiff_t>(i),
              code.at.begin() + static_cast<std::ptrdiff_t>(end), true);
    i = end + fence - 1;
  }
  return code;
}

std::string escaped(std::string_view cell) {
  std::string bars;
  for (const char c : cell) {
    if (c == '|') bars += '\\';
    bars += c;
  }
  const LineCode code = code_of(bars);
  std::string text;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    // Markdown lets HTML through: a name or a reason from outside must not become a tag. Other
    // control characters than a line's end show nothing and break what reads the page.
    const char c = bars[i];
    if (c == '<' && !code.at[i]) {
      text += "&lt;";
    } else if (c >= 0 && c < ' ') {
      text += ' ';
    } else {
      text += c;
    }
  }
  return text;
}

// A line of a page, of whose code `code` tells.
std::string line_without_tags(std::string_view line, const LineCode& code) {
  constexpr std::string_view kOpeners = "/!?";  // of a tag, beside letters
  std::string text;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char next = i + 1 < line.size() ? line[i + 1] : ' ';
    const bool opens = (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z') ||
                       kOpeners.find(next) != std::string_view::npos;
    if (line[i] == '<' && opens && !code.at[i]) {
      text += "&lt;";
    } else {
      text += line[i];
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
  std::string text;
  bool is_certain = true;  // that no code began in a line before, and goes on in this one
  while (!page.empty()) {
    const std::size_t end = std::min(page.find('\n'), page.size());
    const std::string_view line = page.substr(0, end);
    LineCode code = code_of(line);
    is_certain = (is_certain && code.is_certain) || line.empty();
    if (!is_certain) code.at.assign(line.size(), false);
    text += line_without_tags(line, code);
    if (end < page.size()) text += '\n';
    page.remove_prefix(std::min(end + 1, page.size()));
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
