// SPDX-License-Identifier: MIT
#include "problems/reading/csv_head.hpp"

#include <algorithm>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/csv_scanner.hpp"

namespace tribench {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kHeadLines = 60;  // the header stands among these

std::size_t comment_sign(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return 0;
  if (line[first] == '#' || line[first] == '%') return line.find_first_not_of("#%", first);
  if (line.substr(first).starts_with("//")) return first + 2;
  return 0;
}

// Whether a quote that opens a cell is not closed within the text: the cell goes on behind the
// line's end, as spreadsheets write a heading of two lines.
bool has_open_cell(std::string_view text) {
  bool open = false;
  bool at_start = true;  // of a cell
  for (const char c : text) {
    if (c == '"' && (open || at_start)) open = !open;
    at_start = !open && (c == ',' || c == ';' || c == '\t' || c == '|' || (at_start && c == ' '));
  }
  return open;
}

// Of the line that begins there, with those that a quoted cell of it goes on in.
std::size_t end_of_head_line(std::string_view text, std::size_t begin) {
  constexpr int kMostLinesOfCell = 5;
  const auto line_end = [&](std::size_t from) {
    return std::min(text.find('\n', from), text.size());
  };
  const std::size_t first = line_end(begin);
  std::size_t end = first;
  for (int lines = 1; lines < kMostLinesOfCell; ++lines) {
    if (!has_open_cell(text.substr(begin, end - begin))) return end;
    if (end == text.size()) break;
    end = line_end(end + 1);
  }
  return first;  // a mark of inches, or a quote that nothing closes
}

}  // namespace

std::vector<HeadLine> head_of(std::string_view text) {
  std::vector<HeadLine> lines;
  std::size_t number = 1;
  std::size_t begin = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  while (begin < text.size() && lines.size() < kHeadLines) {
    const std::size_t end = end_of_head_line(text, begin);
    const std::string_view line = text.substr(begin, end - begin);
    if (line.find_first_not_of(" \t\r") != std::string_view::npos) {
      const std::size_t sign = comment_sign(line);
      const bool comment = sign != 0;
      lines.push_back(
          {begin, number, comment, comment ? line.substr(std::min(sign, line.size())) : line});
    }
    number += 1 + static_cast<std::size_t>(std::ranges::count(line, '\n'));
    begin = end + 1;
  }
  return lines;
}

Cells cells_of(const HeadLine& line, char delimiter) {
  Cells cells;
  CsvScanner scanner(line.text, "", delimiter, 0, line.number);
  try {
    do {
      cells.emplace_back(trimmed(without_control_characters(scanner.next_cell())));
    } while (scanner.goes_on());
  } catch (const Error&) {  // a quote is open here: the rows will say so with the file's name
  }
  return cells;
}

LabviewHeader take_labview_header(std::vector<HeadLine>& lines) {
  const auto ends_header = [](const HeadLine& line) {
    return line.text.starts_with("***End_of_Header***");
  };
  const auto last = std::find_if(lines.rbegin(), lines.rend(), ends_header).base();
  if (last == lines.begin() || last == lines.end()) return {};
  LabviewHeader header;
  header.lines = (last - 1)->number;
  for (auto line = lines.begin(); line != last; ++line) {
    const bool tabs = line->text.find('\t') != std::string_view::npos;
    if (!line->text.starts_with("Y_Unit_Label")) continue;
    header.units = cells_of(*line, tabs ? '\t' : ',');
    header.units.front() = "";  // of X, which has none in the file
  }
  lines.erase(lines.begin(), last);
  return header;
}

}  // namespace tribench
