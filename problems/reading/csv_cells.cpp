// SPDX-License-Identifier: MIT
#include "problems/reading/csv_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "foundation/error.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// The delimiter the header has most of; comma where it has none.
char find_delimiter(std::string_view text) {
  const std::string_view header = text.substr(0, text.find('\n'));
  char best = ',';
  std::ptrdiff_t most = 0;
  for (const char candidate : {',', ';', '\t'}) {
    const std::ptrdiff_t count = std::count(header.begin(), header.end(), candidate);
    if (count > most) {
      most = count;
      best = candidate;
    }
  }
  return best;
}

// Cuts the text into records; quotes may hold delimiters, line ends and doubled quotes.
class Splitter {
 public:
  Splitter(std::string_view text, std::string_view file, char delimiter)
      : text_(text), file_(file), delimiter_(delimiter) {}

  std::vector<CsvLine> split() {
    std::vector<CsvLine> lines;
    while (place_ < text_.size()) lines.push_back(next_line());
    return lines;
  }

 private:
  CsvLine next_line() {
    CsvLine line;
    line.number = line_number_;
    while (true) {
      line.cells.push_back(next_cell(line.number));
      if (place_ >= text_.size()) break;
      const char end = text_[place_++];
      if (end == '\n') {
        ++line_number_;
        break;
      }
      // A delimiter as the very last character still opens one more, empty cell.
      if (place_ == text_.size()) line.cells.emplace_back();
    }
    return line;
  }

  std::string next_cell(std::size_t line) {
    std::size_t first = place_;
    while (first < text_.size() && (text_[first] == ' ' || is_stray_tab(text_[first]))) ++first;
    if (first < text_.size() && text_[first] == '"') {
      place_ = first + 1;
      return quoted_cell(line);
    }
    const std::size_t begin = place_;
    while (place_ < text_.size() && text_[place_] != '\n' && text_[place_] != delimiter_) ++place_;
    return std::string(trimmed(text_.substr(begin, place_ - begin)));
  }

  bool is_stray_tab(char c) const { return c == '\t' && delimiter_ != '\t'; }

  std::string quoted_cell(std::size_t line) {
    std::string cell;
    while (place_ < text_.size()) {
      const char c = text_[place_++];
      if (c == '\n') ++line_number_;
      if (c != '"') {
        cell += c;
      } else if (place_ < text_.size() && text_[place_] == '"') {
        cell += '"';
        ++place_;
      } else {
        expect_end_of_cell(line);
        return cell;
      }
    }
    throw_bad_input("a quote is opened and never closed", csv_place(file_, line),
                    "close it or remove it");
  }

  void expect_end_of_cell(std::size_t line) {
    while (place_ < text_.size() && (text_[place_] == ' ' || text_[place_] == '\r')) ++place_;
    if (place_ == text_.size() || text_[place_] == '\n' || text_[place_] == delimiter_) return;
    throw_bad_input(fmt::format("text follows a closing quote: '{}'", text_.substr(place_, 10)),
                    csv_place(file_, line), "put the whole cell into the quotes");
  }

  std::string_view text_;
  std::string_view file_;
  char delimiter_;
  std::size_t place_ = 0;
  std::size_t line_number_ = 1;
};

void check_header(const std::vector<std::string>& header, std::string_view file) {
  bool numbers_only = true;
  for (std::size_t j = 0; j < header.size(); ++j) {
    if (header[j].empty()) {
      throw_bad_input(fmt::format("column {} has no name", j + 1), csv_place(file, 1),
                      "name every column in the first line");
    }
    if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(j), header[j]) !=
        header.begin() + static_cast<std::ptrdiff_t>(j)) {
      throw_bad_input(fmt::format("two columns are named '{}'", header[j]), csv_place(file, 1),
                      "rename one of them");
    }
    double value = 0;
    numbers_only = numbers_only && read_cell(header[j], value) == CellKind::number;
  }
  if (numbers_only) {
    throw_bad_input("the first line holds numbers, not names", csv_place(file, 1),
                    "add a line with the columns' names");
  }
}

void check_width(const CsvLine& line, const CsvCells& cells, std::string_view file) {
  const std::size_t expected = cells.header.size();
  if (line.cells.size() == expected || line.blank()) return;
  throw_bad_input(fmt::format("{} cell{} where the header has {}", line.cells.size(),
                              line.cells.size() == 1 ? "" : "s", expected),
                  csv_place(file, line.number),
                  line.cells.size() > expected && cells.delimiter == ','
                      ? "numbers need a decimal point, not a comma; quote a cell that holds a comma"
                      : "complete the line or remove it");
}

}  // namespace

std::string csv_place(std::string_view file, std::size_t line) {
  return fmt::format("{}:{}", file, line);
}

std::string csv_place(std::string_view file, std::size_t line, std::string_view column) {
  return fmt::format("{}:{}:{}", file, line, column);
}

CsvCells split_csv(std::string_view text, std::string_view file) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    const auto line = static_cast<std::size_t>(
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n'));
    throw_bad_input("this is not a text file (it holds a zero byte)", csv_place(file, line),
                    "save it as CSV in UTF-8");
  }
  CsvCells cells;
  cells.delimiter = find_delimiter(text);
  std::vector<CsvLine> lines = Splitter(text, file, cells.delimiter).split();
  while (!lines.empty() && lines.back().blank()) lines.pop_back();
  if (lines.empty()) {
    throw_bad_input("the file is empty", std::string(file), "give a header line and rows");
  }
  cells.header = std::move(lines.front().cells);
  check_header(cells.header, file);
  lines.erase(lines.begin());
  if (lines.empty()) {
    throw_bad_input("there is a header and no row", std::string(file), "add rows");
  }
  cells.lines = std::move(lines);
  for (const CsvLine& line : cells.lines) check_width(line, cells, file);
  return cells;
}

CellKind read_cell(std::string_view cell, double& value) {
  if (cell.empty()) return CellKind::missing;
  const std::string_view unsigned_part =
      cell.front() == '+' || cell.front() == '-' ? cell.substr(1) : cell;
  std::string word;
  for (const char c : unsigned_part) {
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (word.size() > 8) break;
  }
  constexpr std::array kMissing = {"nan", "inf", "infinity", "na", "n/a"};
  if (std::find(kMissing.begin(), kMissing.end(), word) != kMissing.end()) return CellKind::missing;
  // from_chars takes no plus sign and would take a second minus after one.
  const std::string_view digits = cell.front() == '+' ? unsigned_part : cell;
  if (cell.front() == '+' && !digits.empty() && digits.front() == '-') return CellKind::text;
  const char* end = digits.data() + digits.size();
  const auto [stop, code] = std::from_chars(digits.data(), end, value);
  if (stop != end) return CellKind::text;
  // Too small is 0 to the last bit; too large has no double.
  if (code == std::errc::result_out_of_range) {
    value = std::strtod(std::string(digits).c_str(), nullptr);
  } else if (code != std::errc()) {
    return CellKind::text;
  }
  return std::abs(value) <= kLargestNumber ? CellKind::number : CellKind::missing;
}

}  // namespace tribench
