// SPDX-License-Identifier: MIT
#include "problems/reading/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/column_plan.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/csv_checks.hpp"
#include "problems/reading/csv_columns.hpp"
#include "problems/reading/csv_scanner.hpp"
#include "problems/reading/joint_columns.hpp"
#include "problems/reading/thousands.hpp"
#include "problems/reading/time_order.hpp"

namespace tribench {
namespace {

// A file on its way to a dataset: what the functions below work on.
struct Reading {
  std::string_view text;
  std::string_view file;
  const CsvOptions& options;
  CsvLayout layout;
  std::vector<ColumnPlan> plans;
  CsvColumns columns;
  std::vector<std::size_t> rows;  // that are kept
};

std::string stem_of(std::string_view file) {
  std::filesystem::path path(file);
  if (path.extension() == ".gz") path = path.stem();
  return without_control_characters(path.stem().string());
}

double largest_of(const ColumnPlan& plan) {
  return plan.reading.role == Role::none ? kLargestNumber : kLargestMeasured;
}

[[noreturn]] void refuse_cell(const Reading& in, std::size_t row, std::size_t column) {
  const std::size_t place = in.columns.places[row];
  const std::string cell = cell_at(in.text, in.layout, place, column);
  double value = 0;
  const CellKind kind = read_cell(cell, in.layout.decimal_comma, value);
  const std::string what = cell.empty() ? "the cell is empty"
                           : kind == CellKind::number
                               ? fmt::format("'{}' is too large for what is measured", cell)
                               : fmt::format("'{}' is not a finite number", cell);
  const std::vector<double>& values = in.columns.columns[column].numbers;
  const bool is_read =
      std::ranges::any_of(values, [](double number) { return std::isfinite(number); });
  const std::string mend = mend_for_cell({.column = in.layout.header[column],
                                          .cell = cell,
                                          .kind = kind,
                                          .decimal_comma = in.layout.decimal_comma,
                                          .is_time = in.plans[column].reading.role == Role::time,
                                          .others_are_read = is_read,
                                          .drops_missing = in.options.drop_missing});
  throw_bad_input(what, csv_place(in.file, line_of(in.text, place), in.layout.header[column]),
                  mend);
}

// Text in a column of numbers is never dropped silently: only missing values are.
void check_texts(const Reading& in) {
  std::size_t first = kNoRow;
  std::size_t column = 0;
  for (std::size_t j = 0; j < in.plans.size(); ++j) {
    const std::size_t row = in.columns.columns[j].first_text;
    if (in.plans[j].used && row < first) {
      first = row;
      column = j;
    }
  }
  if (first != kNoRow) refuse_cell(in, first, column);
}

bool is_missing(const Reading& in, std::size_t row, std::size_t j) {
  const CsvColumn& column = in.columns.columns[j];
  if (in.plans[j].reading.role == Role::movement) return column.texts[row].empty();
  return column.kind == ColumnKind::number &&
         !(std::abs(column.numbers[row]) <= largest_of(in.plans[j]));
}

// Every row has a missing value.
[[noreturn]] void refuse_gaps(const Reading& in, const std::vector<std::size_t>& looked_at) {
  const std::string what = fmt::format("all {} rows have missing values", in.columns.rows());
  for (const std::size_t j : looked_at) {
    bool empty = true;
    for (std::size_t row = 0; row < in.columns.rows() && empty; ++row) {
      empty = is_missing(in, row, j);
    }
    if (!empty) continue;
    throw_bad_input(fmt::format("{}: '{}' is empty", what, in.layout.header[j]), in.file,
                    "remove the column, or give its role to another");
  }
  throw_bad_input(what + ": the columns were recorded at instants of their own", in.file,
                  "write them at common instants (in PlotJuggler: export one resampled table; in "
                  "pandas: merge_asof)");
}

// A thermometer answers more slowly than a drive: where most rows have no temperature it goes
// straight from one reading to the next.
void join_slow_readings(Reading& in, DataFile& out) {
  for (std::size_t j = 0; j < in.plans.size(); ++j) {
    if (in.plans[j].reading.role != Role::temperature) continue;
    std::vector<double>& values = in.columns.columns[j].numbers;
    std::vector<std::size_t> told;
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (!is_missing(in, row, j)) told.push_back(row);
    }
    if (told.size() < 2 || 2 * told.size() > values.size()) continue;
    std::fill(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(told.front()),
              values[told.front()]);
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(told.back()), values.end(),
              values[told.back()]);
    for (std::size_t k = 1; k < told.size(); ++k) {
      const double begin = values[told[k - 1]];
      const double slope = (values[told[k]] - begin) / static_cast<double>(told[k] - told[k - 1]);
      for (std::size_t row = told[k - 1] + 1; row < told[k]; ++row) {
        values[row] = begin + slope * static_cast<double>(row - told[k - 1]);
      }
    }
    out.warnings.push_back(
        fmt::format("'{}' has a value in {} of {} rows: it goes straight from one to the next",
                    in.layout.header[j], told.size(), values.size()));
  }
}

void choose_rows(Reading& in, DataFile& out) {
  check_texts(in);
  join_slow_readings(in, out);
  std::vector<std::size_t> looked_at;
  for (std::size_t j = 0; j < in.plans.size(); ++j) {
    if (in.plans[j].used && in.plans[j].kind != ColumnKind::unused) looked_at.push_back(j);
  }
  in.rows.reserve(in.columns.rows());
  for (std::size_t row = 0; row < in.columns.rows(); ++row) {
    const auto missing =
        std::ranges::find_if(looked_at, [&](std::size_t j) { return is_missing(in, row, j); });
    if (missing == looked_at.end()) {
      in.rows.push_back(row);
    } else if (!in.options.drop_missing) {
      refuse_cell(in, row, *missing);
    } else {
      ++out.dropped_rows;
    }
  }
  if (in.rows.empty()) refuse_gaps(in, looked_at);
}

void check_rule(const Reading& in) {
  if (!in.options.rule) return;
  const ColumnRule& rule = *in.options.rule;
  const auto column = std::ranges::find(in.layout.header, rule.column) - in.layout.header.begin();
  if (column == std::ssize(in.layout.header)) return;
  const auto j = static_cast<std::size_t>(column);
  if (in.columns.columns[j].kind != ColumnKind::number) return;
  for (const std::size_t row : in.rows) {
    if (rule.holds(in.columns.columns[j].numbers[row])) continue;
    const std::size_t place = in.columns.places[row];
    throw_bad_input(fmt::format("'{}' cannot be used", cell_at(in.text, in.layout, place, j)),
                    csv_place(in.file, line_of(in.text, place), rule.column), rule.words);
  }
}

template <typename Value>
std::vector<Value> kept(std::vector<Value>& values, const std::vector<std::size_t>& rows) {
  if (rows.size() == values.size()) return std::move(values);
  std::vector<Value> some;
  some.reserve(rows.size());
  for (const std::size_t row : rows) some.push_back(std::move(values[row]));
  return some;
}

// Gives each movement its number; rows of one stand together.
void number_movements(Reading& in, const std::vector<std::string>& names, DataFile& out) {
  Dataset& data = out.data;
  std::set<std::string> seen;
  for (std::size_t r = 0; r < names.size(); ++r) {
    if (r == 0 || names[r] != data.movement_names.back()) {
      if (!seen.insert(names[r]).second) {
        throw_bad_input(fmt::format("movement '{}' goes on after another one began", names[r]),
                        csv_place(in.file, line_of(in.text, in.columns.places[in.rows[r]])),
                        "rows of one movement stand together: sort the file, or give each "
                        "recording its own name");
      }
      data.movement_names.push_back(names[r]);
    }
    data.movement.push_back(static_cast<int>(data.movement_names.size()) - 1);
  }
}

void fill_movements(Reading& in, DataFile& out) {
  for (std::size_t j = 0; j < in.plans.size(); ++j) {
    if (in.plans[j].reading.role != Role::movement) continue;
    out.has_movements = true;
    number_movements(in, kept(in.columns.columns[j].texts, in.rows), out);
    return;
  }
  // Without one each recording in the file is a movement.
  const std::vector<std::size_t>& parts = in.columns.parts;
  if (parts.empty()) {
    out.data.movement_names = {stem_of(in.file)};
    out.data.movement.assign(in.rows.size(), 0);
    return;
  }
  std::vector<std::string> names;
  for (const std::size_t row : in.rows) {
    const auto part = std::ranges::upper_bound(parts, row) - parts.begin();
    names.push_back(fmt::format("{}, part {}", stem_of(in.file), part + 1));
  }
  number_movements(in, names, out);
  out.warnings.push_back(fmt::format(
      "the columns' names stand again {} times: another recording begins there", parts.size()));
}

// Nanoseconds of a stamp, to its seconds.
void add_to_time(const Reading& in, DataFile& out) {
  const auto part = std::ranges::find_if(in.plans, &ColumnPlan::adds_to_time);
  if (part == in.plans.end()) return;
  const auto find = [&](bool seconds) {
    return std::ranges::find_if(out.data.channels, [&](const Channel& channel) {
      return channel.role == Role::time && (channel.name == part->reading.column) != seconds;
    });
  };
  const auto seconds = find(true);
  const auto rest = find(false);
  for (std::size_t r = 0; r < seconds->values.size(); ++r) seconds->values[r] += rest->values[r];
  out.data.channels.erase(rest);
}

// The time of rows that are even, by their places in the file: those that are left out count too.
void count_time(const Reading& in, double rate, DataFile& out) {
  constexpr std::string_view kName = "sample_time";
  for (const Channel& channel : out.data.channels) {
    if (channel.role != Role::time && channel.name != kName) continue;
    throw_bad_input(fmt::format("'{}' is a time already", channel.name), "--sample-rate",
                    fmt::format("leave it out, or say --roles '{}=none'", channel.name));
  }
  Channel time{std::string(kName), "s", Role::time, {}};
  for (const std::size_t row : in.rows) time.values.push_back(static_cast<double>(row) / rate);
  out.data.channels.push_back(std::move(time));
  out.warnings.push_back(
      fmt::format("no column is the time: a row every {:.6g} s (--sample-rate)", 1 / rate));
}

// Columns that no name tells may well hold numbers.
[[noreturn]] void refuse_no_channel(const Reading& in, const DataFile& out) {
  if (!out.joints.empty()) {
    throw_bad_input(joints_that_stand_here(out), in.file, "choose one with --joint N");
  }
  if (std::ranges::all_of(in.plans, &ColumnPlan::used)) {
    throw_bad_input("no column holds numbers", in.file, "give at least one column of numbers");
  }
  constexpr std::size_t kShown = 40;
  const std::span shown =
      std::span(in.layout.header).first(std::min(kShown, in.layout.header.size()));
  throw_bad_input(fmt::format("no column's name is known: {}{}", fmt::join(shown, ", "),
                              shown.size() < in.layout.header.size() ? ", ..." : ""),
                  in.file,
                  fmt::format("say what they are, with --roles '{}=time[s],COLUMN=position[UNIT],"
                              "COLUMN=motor_current[A]'",
                              in.layout.header.front()));
}

void add_spare_channel(Reading& in, std::size_t j, DataFile& out) {
  std::vector<double>& numbers = in.columns.columns[j].numbers;
  if (std::ranges::any_of(numbers, [](double x) { return std::abs(x) > kLargestMeasured; })) return;
  out.spare.push_back(in.layout.header[j]);
  out.data.channels.push_back({in.layout.header[j], {}, Role::none, kept(numbers, in.rows)});
}

// The first cell of a column of text, for whoever takes it for numbers.
void note_text(const Reading& in, std::size_t j, Dataset& data) {
  const std::vector<std::string>& texts = in.columns.columns[j].texts;
  const auto first = std::ranges::find_if(texts, [](const auto& text) { return !text.empty(); });
  if (first == texts.end()) return;
  const std::size_t place = in.columns.places[static_cast<std::size_t>(first - texts.begin())];
  const std::string& column = in.layout.header[j];
  data.texts.push_back({column, *first, csv_place(in.file, line_of(in.text, place), column)});
}

void fill_channels(Reading& in, DataFile& out) {
  for (std::size_t j = 0; j < in.plans.size(); ++j) {
    ColumnPlan& plan = in.plans[j];
    CsvColumn& column = in.columns.columns[j];
    if (plan.reading.role != Role::movement && column.kind == ColumnKind::number) {
      Channel channel{in.layout.header[j], {}, plan.reading.role, kept(column.numbers, in.rows)};
      if (column.told_in_text) take_time_text(plan);
      if (column.hexadecimal) {
        out.warnings.push_back(fmt::format(
            "'{}' holds hexadecimal numbers: each is read as a whole number without a sign",
            in.layout.header[j]));
      }
      convert(plan, channel.values, in.options.drive, in.file);
      channel.unit = plan.reading.si;
      out.data.channels.push_back(std::move(channel));
    } else if (plan.reading.role != Role::movement && column.kind == ColumnKind::text) {
      note_text(in, j, out.data);
      out.texts.push_back({in.layout.header[j], kept(column.texts, in.rows)});
    } else if (column.kind == ColumnKind::spare) {
      add_spare_channel(in, j, out);
    }
    out.readings.push_back(plan.reading);
  }
  if (out.data.channels.size() == out.spare.size()) refuse_no_channel(in, out);
  add_to_time(in, out);
  if (in.options.sample_rate) count_time(in, *in.options.sample_rate, out);
}

// Whether numbers whose thousands are parted stand in the columns that are used, and the whole file
// tells by which sign.
bool take_thousands(Reading& in, DataFile& out) {
  std::vector<bool> looked_at(in.plans.size(), false);
  std::string example;
  for (std::size_t j = 0; j < in.plans.size(); ++j) {
    const CsvColumn& column = in.columns.columns[j];
    if (!in.plans[j].used || in.plans[j].kind == ColumnKind::text || column.told_in_text) continue;
    const bool is_number = column.kind == ColumnKind::number;
    const std::size_t row = is_number ? column.first_text : 0;
    const std::string cell = row == kNoRow || in.columns.rows() == 0
                                 ? std::string()
                                 : cell_at(in.text, in.layout, in.columns.places[row], j);
    const bool is_parted = may_hold_thousands(cell);
    looked_at[j] = is_number || is_parted;
    if (is_parted && example.empty()) example = cell;
  }
  if (example.empty()) return false;
  const auto signs = find_thousands(in.text, in.file, in.layout, looked_at);
  if (!signs) return false;
  in.layout.thousands = signs->thousands;
  in.layout.decimal_comma = signs->decimal == ',';
  double value = 0;
  read_cell(without_thousands(example, signs->thousands), in.layout.decimal_comma, value);
  out.warnings.push_back(fmt::format("'{}' parts the thousands: '{}' is read as {}",
                                     signs->thousands, example, value));
  return true;
}

// A role may name its column without the unit that the header writes behind it, where no other
// column is called so.
CsvOptions with_whole_names(CsvOptions options, const CsvLayout& layout) {
  GivenRoles whole;
  for (const auto& [column, role] : options.roles) {
    const auto is_meant = [&column = column](const std::string& name) {
      return without_unit(name) == column;
    };
    const auto meant = std::ranges::find_if(layout.header, is_meant);
    const bool is_short = std::ranges::count(layout.header, column) == 0 &&
                          std::ranges::count_if(layout.header, is_meant) == 1 &&
                          !options.roles.contains(*meant);
    whole.emplace(is_short ? *meant : column, role);
  }
  options.roles = std::move(whole);
  return options;
}

}  // namespace

DataFile parse_csv(std::string_view text, std::string_view file, const CsvOptions& told) {
  DataFile out;
  const bool nameless = told.roles.contains("column_1") || told.roles.contains("column_2");
  CsvLayout layout = find_layout(text, file, nameless);
  const CsvOptions options = with_whole_names(told, layout);
  Reading in{text, file, options, std::move(layout), {}, {}, {}};
  in.plans = plan_columns(in.layout, options, file, out);
  std::vector<ColumnKind> kinds;
  for (const ColumnPlan& plan : in.plans) kinds.push_back(plan.kind);
  in.columns = read_columns(text, file, in.layout, kinds);
  if (take_thousands(in, out)) in.columns = read_columns(text, file, in.layout, kinds);
  if (in.columns.rows() == 0) throw_bad_input("there is a header and no row", file, "add rows");
  for (const auto* notes : {&in.layout.notes, &in.columns.notes}) {
    out.warnings.insert(out.warnings.end(), notes->begin(), notes->end());
  }
  out.data.name = stem_of(file);
  choose_rows(in, out);
  check_rule(in);
  fill_movements(in, out);
  fill_channels(in, out);
  order_by_time(
      out, [&](std::size_t row) { return line_of(text, in.columns.places[in.rows[row]]); }, file);
  if (options.names_tell) find_joints_in_turn(in.layout, out);
  check_torque_units(out.data, file);
  return out;
}

}  // namespace tribench
