// SPDX-License-Identifier: MIT
#include "problems/reading/csv_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "foundation/text.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/csv_scanner.hpp"
#include "problems/reading/thousands.hpp"
#include "problems/reading/time_text.hpp"

namespace tribench {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// A clock without a date starts again at midnight, one of minutes at the full hour; rows that were
// overtaken may still be from before.
void pass_full_clock(std::vector<double>& times, bool in_minutes) {
  const double full = in_minutes ? 3600 : 86400;
  const double longest_pause = in_minutes ? 300 : full / 2;  // else another recording begins
  constexpr double kLongestDelay = 60;                       // of a row that others overtook
  const auto is_clock = [&](double time) { return std::isnan(time) || time < full + 1; };
  if (!std::ranges::all_of(times, is_clock)) return;
  double passed = 0;
  double before = 0;  // as the clock told it
  for (double& time : times) {
    if (std::isnan(time)) continue;
    if (before - time > full - longest_pause) {
      passed += full;
    } else if (time - before > full - kLongestDelay && passed > 0) {
      passed -= full;
    }
    before = time;
    time += passed;
  }
}

class ColumnReader {
 public:
  ColumnReader(std::string_view text, std::string_view file, const CsvLayout& layout,
               std::span<const ColumnKind> kinds)
      : text_(text),
        file_(file),
        layout_(layout),
        scanner_(text, file, layout.delimiter, layout.begin, layout.line) {
    for (const ColumnKind kind : kinds) out_.columns.push_back({kind, {}, {}, kNoRow});
  }

  CsvColumns read() {
    const std::size_t width = layout_.width_behind_sign();
    while (scanner_.find_record(width)) {
      if (begins_anew()) continue;
      const std::size_t line = scanner_.line();
      const std::size_t place = scanner_.place();
      if (!read_row(line, place)) break;
      out_.places.push_back(place);
      if (out_.places.size() == 100) reserve(place);
    }
    for (CsvColumn& column : out_.columns) {
      if (column.told_in_text) pass_full_clock(column.numbers, column.told_in_minutes);
      if (column.kind == ColumnKind::found || column.kind == ColumnKind::time) {
        column.kind = ColumnKind::number;
      }
    }
    return std::move(out_);
  }

 private:
  // The line of names stands here again.
  bool begins_anew() {
    const std::size_t place = scanner_.place();
    if (layout_.head.empty() || text_[place] != layout_.head.front() ||
        !text_.substr(place).starts_with(layout_.head)) {
      return false;
    }
    if (out_.rows() > 0) out_.parts.push_back(out_.rows());
    while (scanner_.place() < place + layout_.head.size()) scanner_.skip_line();
    return true;
  }

  // Words after the last row ("Recording stopped"): no line from `place` on has a number or is as
  // wide as a row.
  bool is_closing_text(std::size_t place, std::size_t line) const {
    constexpr std::size_t kMostLines = 20;
    CsvScanner probe(text_, file_, layout_.delimiter, place, line);
    for (std::size_t lines = 0; probe.find_record(0); ++lines) {
      std::size_t cells = 0;
      do {
        double value = 0;
        if (read(probe.next_cell(), value) == CellKind::number) {
          return false;
        }
        ++cells;
      } while (probe.goes_on());
      if (lines == kMostLines || cells == out_.columns.size()) return false;
    }
    return true;
  }

  // From the first hundred rows the size of the whole is plain.
  void reserve(std::size_t place) {
    const double share = static_cast<double>(text_.size()) /
                         static_cast<double>(std::max<std::size_t>(place - layout_.begin, 1));
    const auto rows = static_cast<std::size_t>(std::min(110 * share, 1e8));
    out_.places.reserve(rows);
    for (CsvColumn& column : out_.columns) {
      if (holds_numbers(column.kind)) column.numbers.reserve(rows);
    }
  }

  // False: what is left is no row, and nothing of it is kept.
  bool read_row(std::size_t line, std::size_t place) {
    std::size_t cells = 0;
    bool more = true;
    while (more && cells < out_.columns.size()) {
      read_next(out_.columns[cells++]);
      more = scanner_.goes_on();
    }
    if (cells == out_.columns.size() && !more) return true;
    bool last_is_empty = false;
    while (more) {
      last_is_empty = scanner_.next_cell().empty();
      ++cells;
      more = scanner_.goes_on();
    }
    if (cells < out_.columns.size() && scanner_.at_end() && text_.back() != '\n' &&
        out_.rows() > 0) {
      take_back();
      out_.notes.push_back(fmt::format("the last line ({}) is cut off and left out", line));
      return false;
    }
    if (out_.rows() > 0 && is_closing_text(place, line)) {
      take_back();
      out_.notes.push_back(fmt::format("the text after the last row (line {}) is left out", line));
      return false;
    }
    check_width(cells, last_is_empty, layout_, file_, line);
    return true;
  }

  void take_back() {
    for (CsvColumn& column : out_.columns) {
      if (column.numbers.size() > out_.rows()) column.numbers.pop_back();
      if (column.texts.size() > out_.rows()) column.texts.pop_back();
      if (column.first_text == out_.rows()) column.first_text = kNoRow;
    }
  }

  void read_next(CsvColumn& column) {
    const bool is_plain = layout_.thousands.empty() && holds_numbers(column.kind);
    if (is_plain && read_number_in_place(column)) return;
    const std::string_view cell = scanner_.next_cell();
    switch (column.kind) {
      case ColumnKind::unused:
        return;
      case ColumnKind::text:
        column.texts.push_back(without_control_characters(cell));
        return;
      case ColumnKind::found:
        settle(column, cell);
        return;
      case ColumnKind::number:
        add_number(column, cell);
        return;
      case ColumnKind::spare:
        add_spare(column, cell);
        return;
      case ColumnKind::time:
        add_time(column, cell);
        return;
    }
  }

  CellKind read(std::string_view cell, double& value) const {
    if (layout_.thousands.empty()) return read_cell(cell, layout_.decimal_comma, value);
    return read_cell(without_thousands(cell, layout_.thousands), layout_.decimal_comma, value);
  }

  // The usual cell: digits up to the delimiter or the line's end.
  bool read_number_in_place(CsvColumn& column) {
    std::size_t place = scanner_.place();
    while (place < text_.size() && text_[place] == ' ') ++place;
    const char* const end = text_.data() + text_.size();
    double value = 0;
    const auto [stop, code] = std::from_chars(text_.data() + place, end, value);
    if (code != std::errc() || !std::isfinite(value)) return false;
    const bool ends_line =
        stop == end || *stop == '\n' || (*stop == '\r' && (stop + 1 == end || stop[1] == '\n'));
    if (!ends_line && *stop != layout_.delimiter) return false;
    column.numbers.push_back(value);
    scanner_.move_to(static_cast<std::size_t>(stop - text_.data()));
    return true;
  }

  void settle(CsvColumn& column, std::string_view cell) {
    double value = 0;
    const CellKind kind = read(cell, value);
    if (kind == CellKind::missing) {
      column.numbers.push_back(kMissing);
    } else if (kind == CellKind::number) {
      column.kind = ColumnKind::number;
      column.hexadecimal = is_hexadecimal(cell);
      column.numbers.push_back(value);
    } else {
      column.kind = ColumnKind::text;
      column.texts.resize(column.numbers.size());
      column.numbers = {};
      column.texts.push_back(without_control_characters(cell));
    }
  }

  void add_number(CsvColumn& column, std::string_view cell) {
    double value = kMissing;
    const CellKind kind = read(cell, value);
    if (kind == CellKind::text && column.first_text == kNoRow) column.first_text = out_.rows();
    column.hexadecimal = column.hexadecimal || is_hexadecimal(cell);
    column.numbers.push_back(kind == CellKind::number ? value : kMissing);
  }

  static bool holds_numbers(ColumnKind kind) {
    return kind == ColumnKind::number || kind == ColumnKind::spare;
  }

  void add_spare(CsvColumn& column, std::string_view cell) {
    double value = 0;
    if (read(cell, value) == CellKind::number) {
      column.numbers.push_back(value);
      return;
    }
    column.kind = ColumnKind::unused;
    column.numbers = {};
  }

  void add_time(CsvColumn& column, std::string_view cell) {
    std::optional<double> time = read_time_text(cell);
    if (!time) time = read_clock_behind_date(cell);
    if (!time && !column.told_in_text) {
      column.kind = ColumnKind::number;
      add_number(column, cell);
      return;
    }
    const bool in_minutes = std::ranges::count(cell, ':') == 1;
    if (!column.told_in_text) column.told_in_minutes = in_minutes;
    if (time && !in_minutes) column.told_in_minutes = false;
    column.told_in_text = true;
    if (time) {
      column.numbers.push_back(*time);
    } else if (double value = 0; read_cell(cell, false, value) == CellKind::missing) {
      column.numbers.push_back(kMissing);
    } else {
      if (column.first_text == kNoRow) column.first_text = out_.rows();
      column.numbers.push_back(kMissing);
    }
  }

  std::string_view text_;
  std::string_view file_;
  const CsvLayout& layout_;
  CsvScanner scanner_;
  CsvColumns out_;
};

}  // namespace

CsvColumns read_columns(std::string_view text, std::string_view file, const CsvLayout& layout,
                        std::span<const ColumnKind> kinds) {
  return ColumnReader(text, file, layout, kinds).read();
}

std::size_t line_of(std::string_view text, std::size_t place) {
  return static_cast<std::size_t>(
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
}

std::string cell_at(std::string_view text, const CsvLayout& layout, std::size_t place,
                    std::size_t column) {
  CsvScanner scanner(text, "", layout.delimiter, place, 1);
  for (std::size_t j = 0; j < column; ++j) {
    scanner.next_cell();
    scanner.goes_on();
  }
  return std::string(scanner.next_cell());
}

}  // namespace tribench
