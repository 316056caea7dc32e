// SPDX-License-Identifier: MIT
#include "problems/reading/csv_scanner.hpp"

#include <fmt/format.h>

#include "foundation/error.hpp"

namespace tribench {

std::string csv_place(std::string_view file, std::size_t line) {
  return fmt::format("{}:{}", file, line);
}

std::string csv_place(std::string_view file, std::size_t line, std::string_view column) {
  return fmt::format("{}:{}:{}", file, line, column);
}

bool CsvScanner::is_comment(std::size_t width) const {
  std::size_t first = place_;
  while (first < text_.size() && is_blank(text_[first])) ++first;
  if (first >= text_.size()) return false;
  const bool sign =
      text_[first] == '#' || text_[first] == '%' || text_.substr(first).starts_with("//");
  if (!sign || width < 2) return sign;
  CsvScanner probe(text_, file_, delimiter_, place_, line_);
  std::size_t cells = 1;
  const std::string_view begin = probe.next_cell();
  if (delimiter_ == ' ' && (begin == "#" || begin == "%" || begin == "//")) return true;
  for (; probe.goes_on(); ++cells) probe.next_cell();
  return cells != width;
}

bool CsvScanner::find_record(std::size_t width) {
  while (place_ < text_.size()) {
    const char c = text_[place_];
    if (c == '\n') {
      ++place_;
      ++line_;
    } else if (is_blank(c) && text_.find_first_not_of(" \t\r", place_) < text_.size() &&
               text_[text_.find_first_not_of(" \t\r", place_)] == '\n') {
      skip_line();
    } else if ((c == '#' || c == '%' || c == '/' || c == ' ') && is_comment(width)) {
      skip_line();
    } else {
      return true;
    }
  }
  return false;
}

void CsvScanner::skip_line() {
  place_ = text_.find('\n', place_);
  if (place_ == std::string_view::npos) {
    place_ = text_.size();
  } else {
    ++place_;
    ++line_;
  }
}

std::string_view CsvScanner::next_cell() {
  while (place_ < text_.size() && is_blank(text_[place_])) ++place_;
  if (place_ < text_.size() && text_[place_] == '"') {
    ++place_;
    return quoted_cell();
  }
  const std::size_t begin = place_;
  while (place_ < text_.size() && text_[place_] != '\n' && text_[place_] != delimiter_) ++place_;
  std::size_t end = place_;
  while (end > begin && (is_blank(text_[end - 1]) || text_[end - 1] == '\t')) --end;
  return text_.substr(begin, end - begin);
}

std::string_view CsvScanner::quoted_cell() {
  const std::size_t opened = line_;
  unquoted_.clear();
  while (place_ < text_.size()) {
    const char c = text_[place_++];
    if (c == '\n') ++line_;
    if (c != '"') {
      unquoted_ += c;
      continue;
    }
    if (place_ < text_.size() && text_[place_] == '"') {
      unquoted_ += '"';
      ++place_;
      continue;
    }
    while (place_ < text_.size() && (text_[place_] == ' ' || text_[place_] == '\r') &&
           delimiter_ != ' ') {
      ++place_;
    }
    if (place_ == text_.size() || text_[place_] == '\n' || text_[place_] == '\r' ||
        text_[place_] == delimiter_) {
      return unquoted_;
    }
    throw_bad_input(fmt::format("text follows a closing quote: '{}'", text_.substr(place_, 10)),
                    csv_place(file_, opened), "put the whole cell into the quotes");
  }
  throw_bad_input("a quote is opened and never closed", csv_place(file_, opened),
                  "close it or remove it");
}

bool CsvScanner::goes_on() {
  if (delimiter_ == ' ') {
    while (place_ < text_.size() && is_blank(text_[place_])) ++place_;
    if (place_ < text_.size() && text_[place_] != '\n') return true;
  }
  if (place_ < text_.size() && text_[place_] == '\r') ++place_;
  if (place_ >= text_.size()) return false;
  const char end = text_[place_++];
  if (end != '\n') return true;
  ++line_;
  return false;
}

}  // namespace tribench
