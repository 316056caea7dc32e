// SPDX-License-Identifier: MIT
#include "problems/reading/csv_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/csv_head.hpp"
#include "problems/reading/csv_scanner.hpp"
#include "problems/reading/foreign_formats.hpp"
#include "problems/reading/thousands.hpp"
#include "problems/reading/units.hpp"

namespace tribench {
namespace {

bool is_number(std::string_view cell) {
  double value = 0;
  return read_cell(cell, true, value) == CellKind::number || may_hold_thousands(cell);
}

// A line of data: numbers, or at least one among gaps and texts.
bool is_row(const Cells& cells) { return std::ranges::any_of(cells, is_number); }

bool names_columns(const Cells& cells) {
  const auto numbers = std::ranges::count_if(cells, is_number);
  const auto empty = std::ranges::count(cells, std::string());
  const auto all = static_cast<std::ptrdiff_t>(cells.size());
  return numbers == 0 && empty < all && (empty <= 1 || empty * 4 < all);
}

// Cells that are a unit, and those that are something else.
struct UnitCells {
  std::size_t units = 0;
  std::size_t others = 0;
};

UnitCells count_units(const Cells& cells) {
  UnitCells count;
  for (std::string_view cell : cells) {
    if (cell.size() > 2 && (cell.front() == '[' || cell.front() == '(')) {
      cell = cell.substr(1, cell.size() - 2);
    }
    if (find_written_unit(cell).unit != nullptr) {
      ++count.units;
    } else if (!cell.empty() && cell != "-" && cell != "1") {
      ++count.others;
    }
  }
  return count;
}

// Whether a line is a row of units below the names in `above`: units throughout, or mostly, where
// the line above has fewer (some unit may be in another language).
bool names_units(const Cells& cells, const Cells& above) {
  const UnitCells count = count_units(cells);
  if (count.units == 0) return false;
  return count.others == 0 ||
         (count.units > count.others && count_units(above).units < count.units);
}

// As many cells, but for a separator at the end of either line.
bool same_width(const Cells& header, const Cells& row) {
  if (header.size() == row.size()) return true;
  if (row.size() == header.size() + 1) return row.back().empty();
  return header.size() == row.size() + 1 && header.back().empty();
}

struct Found {
  char delimiter = ',';
  std::optional<std::size_t> header;  // place among the head's lines
  std::optional<std::size_t> units;
  std::size_t row = 0;
  std::size_t width = 0;
  bool labelled = false;  // from the header to the row each cell stands behind a label
  bool guessed = false;   // no layout fits
};

// The first row: from it on at least half of the lines are as wide. What a recorder says of itself
// ("Serial;4711") is followed by other lines. None: the number of lines.
std::size_t first_row(const std::vector<HeadLine>& lines, const std::vector<Cells>& cells) {
  std::size_t first = lines.size();
  for (std::size_t row = 0; row < lines.size(); ++row) {
    if (lines[row].comment || !is_row(cells[row])) continue;
    first = std::min(first, row);
    std::size_t all = 0;
    std::size_t as_wide = 0;
    for (std::size_t i = row; i < lines.size(); ++i) {
      if (lines[i].comment) continue;
      ++all;
      as_wide += same_width(cells[row], cells[i]) ? 1 : 0;
    }
    if (2 * as_wide >= all) return row;
  }
  return first;
}

// The layout that a delimiter would mean; no header: it means none.
Found try_delimiter(const std::vector<HeadLine>& lines, char delimiter) {
  Found found{delimiter, {}, {}, 0, 0};
  std::vector<Cells> cells;
  for (const HeadLine& line : lines) cells.push_back(cells_of(line, delimiter));
  const std::size_t row = first_row(lines, cells);
  if (row == lines.size()) return found;
  found.row = row;
  const auto search = [&](bool comments) {
    for (std::size_t i = row; i-- > 0;) {
      if (lines[i].comment != comments || !same_width(cells[i], cells[row])) continue;
      const auto is_above = [&](const Cells& other) {
        return same_width(other, cells[row]) && names_columns(other) &&
               names_units(cells[i], other);
      };
      if (!found.units &&
          std::any_of(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(i), is_above)) {
        found.units = i;
        continue;
      }
      if (!names_columns(cells[i])) continue;
      found.header = i;
      found.width = cells[row].size();
      return;
    }
  };
  search(false);
  if (!found.header) search(true);
  return found;
}

// Where no layout fits: the first line that is no comment names the columns, and what is wrong
// with the rows is said there. What parts it into most cells parts them, or rather what parts the
// next line into as many: a name may hold the others.
Found plain_layout(const std::vector<HeadLine>& lines) {
  Found found;
  std::size_t first = 0;
  while (first + 1 < lines.size() && lines[first].comment) ++first;
  std::pair<bool, std::size_t> best = {false, 1};
  for (const char candidate : {',', ';', '\t', '|'}) {
    const Cells header = cells_of(lines[first], candidate);
    const bool agrees = header.size() > 1 && first + 1 < lines.size() &&
                        same_width(header, cells_of(lines[first + 1], candidate));
    const std::pair cells(agrees, header.size());
    if (cells <= best) continue;
    best = cells;
    found.delimiter = candidate;
  }
  found.header = first;
  found.row = first + 1;
  found.guessed = true;
  return found;
}

// "Name;Position;Name;Velocity": each value behind the same label.
bool is_labelled(const Cells& cells) {
  if (cells.size() < 4 || cells.front().empty() || is_number(cells.front())) return false;
  for (std::size_t j = 0; j < cells.size(); j += 2) {
    if (cells[j] != cells.front() && (j + 1 < cells.size() || !cells[j].empty())) return false;
  }
  return true;
}

// As TwinCAT's scope writes it: a block of such lines, that of the names first, then rows in which
// each channel stands behind its own time.
std::optional<Found> labelled_layout(const std::vector<HeadLine>& lines) {
  for (const char delimiter : {';', '\t', ','}) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const Cells names = cells_of(lines[i], delimiter);
      if (!is_labelled(names) || names.front() != "Name") continue;
      std::size_t row = i + 1;
      while (row < lines.size() && is_labelled(cells_of(lines[row], delimiter))) ++row;
      if (row < i + 2 || row == lines.size()) continue;
      const Cells first = cells_of(lines[row], delimiter);
      if (!is_row(first) || !same_width(names, first)) continue;
      return Found{delimiter, i, {}, row, first.size(), true};
    }
  }
  return {};
}

// The names and the units of such a block.
void read_labels(const std::vector<HeadLine>& lines, const Found& found, CsvLayout& layout) {
  std::string time = "time";
  layout.units.assign(layout.header.size(), "");
  for (std::size_t i = *found.header; i < found.row; ++i) {
    const Cells cells = cells_of(lines[i], found.delimiter);
    const std::string& label = cells.front();
    if (label.starts_with("SampleTime"))
      time += " " + label.substr(std::min(label.find('['), label.size()));
    for (std::size_t j = 1; label == "Unit" && j < cells.size(); j += 2) {
      layout.units[j] = cells[j] == "1" ? "" : cells[j];
    }
  }
  for (std::size_t j = 0; j < layout.header.size(); j += 2) layout.header[j] = trimmed(time);
}

// Between blanks a separator would be a name: it is the file's, with blanks to either side.
bool has_lone_separator(const Cells& cells) {
  return std::ranges::any_of(
      cells, [](const std::string& cell) { return cell == "," || cell == ";" || cell == "|"; });
}

Found best_layout(const std::vector<HeadLine>& lines) {
  if (const std::optional<Found> found = labelled_layout(lines)) return *found;
  Found best;
  for (const char delimiter : {',', ';', '\t', '|', ' '}) {
    const Found found = try_delimiter(lines, delimiter);
    if (!found.header) continue;
    if (delimiter == ' ' && has_lone_separator(cells_of(lines[*found.header], delimiter))) continue;
    // As wide, a comment with a comma is no line of names beside one that is none.
    const bool is_plainer = best.header && found.width == best.width &&
                            lines[*best.header].comment && !lines[*found.header].comment;
    if (!best.header || found.width > best.width || is_plainer) best = found;
  }
  // One column: blanks may well be part of its name.
  return best.header ? best : plain_layout(lines);
}

// Whether two columns hold the same in all rows of the head, as where a recorder gives each channel
// the time. What stands still there may differ later.
bool is_repeated(const std::vector<Cells>& rows, std::size_t first, std::size_t second) {
  const bool same = std::ranges::all_of(
      rows, [&](const Cells& row) { return second < row.size() && row[first] == row[second]; });
  return same && rows.size() > 1 && rows.front()[first] != rows.back()[first];
}

// A column that is repeated gets a name of its own, which means nothing.
void name_repeated(std::vector<std::string>& header, const std::vector<Cells>& rows,
                   std::vector<std::string>& notes) {
  std::map<std::string, std::size_t, std::less<>> places;
  std::string noted;
  for (std::size_t j = 0; j < header.size(); ++j) {
    const auto [first, is_new] = places.try_emplace(header[j], j);
    if (is_new || header[j].empty() || !is_repeated(rows, first->second, j)) continue;
    if (noted.empty()) noted = header[j];
    std::string name = header[j];
    while (!places.try_emplace(name, j).second) name += " again";
    header[j] = std::move(name);
  }
  if (!noted.empty()) {
    notes.push_back(
        fmt::format("column '{}' stands in the file again: the first one counts", noted));
  }
}

// Numbers from the first line on that is no comment.
std::optional<Found> nameless_layout(const std::vector<HeadLine>& lines) {
  std::size_t first = 0;
  while (first < lines.size() && lines[first].comment) ++first;
  if (first == lines.size()) return {};
  std::optional<Found> best;
  for (const char delimiter : {',', ';', '\t', '|', ' '}) {
    Cells cells = cells_of(lines[first], delimiter);
    if (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    if (!std::ranges::all_of(cells, is_number)) continue;
    if (!best || cells.size() > best->width) {
      best = {delimiter, {}, {}, first, cells.size()};
    }
  }
  return best;
}

// Where no line names the columns, and rows begin further down: what is before them is no table.
void check_begin(const std::vector<HeadLine>& lines, std::string_view file) {
  constexpr std::size_t kFewestRows = 3;
  for (const char delimiter : {',', ';', '\t', '|', ' '}) {
    std::vector<Cells> cells;
    for (const HeadLine& line : lines) cells.push_back(cells_of(line, delimiter));
    const std::size_t row = first_row(lines, cells);
    if (row < 2 || row + kFewestRows > lines.size() || cells[row].size() < 2) continue;
    if (same_width(cells.front(), cells[row])) continue;
    throw_bad_input(
        fmt::format("the file begins with a block of {} lines, and none of them names the {} "
                    "columns of the rows from line {} on",
                    lines[row].number - 1, cells[row].size(), lines[row].number),
        csv_place(file, lines[row].number),
        fmt::format("leave the block out (tail -n +{} FILE > OTHER) and write a line of names "
                    "before the rows",
                    lines[row].number));
  }
}

void check_header(std::vector<std::string>& header, std::string_view file, std::size_t line) {
  std::set<std::string_view> seen;
  const auto holds_numbers = [](std::string_view cell) {
    return cell.find_first_of("0123456789") != std::string_view::npos &&
           cell.find_first_not_of("0123456789.,eE+- \t\r") == std::string_view::npos;
  };
  if (std::ranges::all_of(header, holds_numbers)) {
    throw_bad_input("the first line holds numbers, not names", csv_place(file, line),
                    "add a line with the columns' names before it, or say what each is: --roles "
                    "'column_1=time[s],column_2=position[deg],column_3=motor_current[A]'");
  }
  if (header.size() > 1 && header.front().empty()) header.front() = "index";  // as pandas writes it
  for (std::size_t j = 0; j < header.size(); ++j) {
    if (header[j].empty()) {
      throw_bad_input(fmt::format("column {} has no name", j + 1), csv_place(file, line),
                      "name every column in the first line");
    }
    if (!seen.insert(header[j]).second) {
      throw_bad_input(fmt::format("two columns are named '{}'", header[j]), csv_place(file, line),
                      "rename one of them");
    }
  }
}

// Digits, a comma, digits: not the thousands of a number with several commas.
bool has_decimal_comma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos || cell.find(',', comma + 1) != std::string_view::npos) {
    return false;
  }
  double value = 0;
  return cell.find('.') == std::string_view::npos &&
         read_cell(cell, true, value) == CellKind::number;
}

// Of a number with one comma: "1,234" may be more than a thousand, "0,234" and "1,23" are less.
bool may_be_thousands(std::string_view cell) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  const std::size_t comma = cell.find(',');
  return comma <= 3 && !cell.starts_with('0') && cell.size() == comma + 4;
}

// Where commas part the cells, a comma inside one may be a sign for thousands: it is decimal where
// a number shows that, and none beside those that leave it open has a decimal point.
bool uses_decimal_commas(const std::vector<HeadLine>& lines, const Found& found) {
  bool open = false;
  bool shown = false;
  bool points = false;
  for (std::size_t i = found.row; i < lines.size(); ++i) {
    if (lines[i].comment) continue;
    for (const std::string& cell : cells_of(lines[i], found.delimiter)) {
      if (has_decimal_comma(cell)) {
        (found.delimiter == ',' && may_be_thousands(cell) ? open : shown) = true;
      } else {
        points = points || (cell.find('.') != std::string::npos && is_number(cell));
      }
    }
  }
  return shown && !(open && points);
}

void check_bytes(std::string_view text, std::string_view file) {
  const std::size_t nul = text.find('\0');
  if (nul == std::string_view::npos) return;
  const auto line = static_cast<std::size_t>(
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n'));
  throw_bad_input("this is not a text file (it holds a zero byte)", csv_place(file, line),
                  "save it as CSV in UTF-8");
}

std::vector<Cells> rows_of(const std::vector<HeadLine>& lines, const Found& found) {
  std::vector<Cells> rows;
  for (std::size_t i = found.row; i < lines.size(); ++i) {
    if (!lines[i].comment) rows.push_back(cells_of(lines[i], found.delimiter));
  }
  return rows;
}

void take_off_single_quotes(std::vector<std::string>& header) {
  const auto is_quoted = [](const std::string& name) {
    return name.size() > 2 && name.front() == '\'' && name.back() == '\'';
  };
  if (!std::ranges::all_of(header, is_quoted)) return;
  for (std::string& name : header) name = name.substr(1, name.size() - 2);
}

CsvLayout layout_without_names(const std::vector<HeadLine>& lines, const Found& found) {
  CsvLayout layout;
  layout.delimiter = found.delimiter;
  for (std::size_t j = 1; j <= found.width; ++j)
    layout.header.push_back(fmt::format("column_{}", j));
  layout.begin = lines[found.row].begin;
  layout.line = lines[found.row].number;
  layout.decimal_comma = uses_decimal_commas(lines, found);
  layout.first_rows = rows_of(lines, found);
  return layout;
}

std::string without_brackets(std::string_view cell) {
  if (cell.size() > 2 && (cell.front() == '[' || cell.front() == '(')) {
    cell = cell.substr(1, cell.size() - 2);
  }
  return std::string(cell == "-" || cell == "1" ? "" : cell);
}

}  // namespace

std::size_t CsvLayout::width_behind_sign() const {
  const bool begins_with_number =
      std::ranges::any_of(first_rows, [&](const std::vector<std::string>& row) {
        double value = 0;
        return !row.empty() && read_cell(row.front(), decimal_comma, value) == CellKind::number;
      });
  return begins_with_number ? 0 : header.size();
}

CsvLayout find_layout(std::string_view text, std::string_view file, bool nameless) {
  check_bytes(text, file);
  std::vector<HeadLine> lines = head_of(text);
  const LabviewHeader labview = take_labview_header(lines);
  if (lines.empty()) {
    throw_bad_input("the file is empty", std::string(file), "give a header line and rows");
  }
  refuse_foreign_text(lines.front().text, file, lines.front().number);
  if (nameless) {
    if (const std::optional<Found> found = nameless_layout(lines)) {
      return layout_without_names(lines, *found);
    }
  }
  const Found found = best_layout(lines);
  if (found.guessed) check_begin(lines, file);
  const HeadLine& header = lines[*found.header];
  CsvLayout layout;
  layout.delimiter = found.delimiter;
  layout.header = cells_of(header, found.delimiter);
  const bool has_rows = found.row < lines.size();
  const Cells first = has_rows ? cells_of(lines[found.row], found.delimiter) : Cells();
  // A separator at the end of the lines names no column where the rows have nothing there either.
  if (layout.header.size() > 1 && layout.header.back().empty() && has_rows &&
      (first.size() < layout.header.size() || first.back().empty())) {
    layout.header.pop_back();
  }
  take_off_single_quotes(layout.header);
  if (found.labelled) read_labels(lines, found, layout);
  layout.first_rows = rows_of(lines, found);
  name_repeated(layout.header, layout.first_rows, layout.notes);
  check_header(layout.header, file, header.number);
  if (!has_rows) throw_bad_input("there is a header and no row", std::string(file), "add rows");
  layout.begin = lines[found.row].begin;
  layout.line = lines[found.row].number;
  layout.head = text.substr(header.begin, layout.begin - header.begin);
  layout.decimal_comma = uses_decimal_commas(lines, found);
  if (found.units) {
    for (const std::string& cell : cells_of(lines[*found.units], found.delimiter)) {
      layout.units.push_back(without_brackets(cell));
    }
    layout.units.resize(layout.header.size());
  }
  if (!labview.units.empty()) {
    layout.units.clear();
    for (const std::string& cell : labview.units) layout.units.push_back(without_brackets(cell));
    layout.units.resize(layout.header.size());
  }
  std::size_t titles = labview.lines;
  for (std::size_t i = 0; i < *found.header; ++i) titles += lines[i].comment ? 0 : 1;
  if (titles > 0) {
    layout.notes.push_back(
        fmt::format("{} lines before the columns' names are passed over", titles));
  }
  return layout;
}

}  // namespace tribench
