// SPDX-License-Identifier: MIT
#include "problems/reading/time_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/reading/name_words.hpp"

namespace tribench {
namespace {

bool is_named_time(const ColumnPlan& plan, std::string_view unit) {
  const ColumnReading& reading = plan.reading;
  return reading.role == Role::time && plan.unit.symbol() == unit && reading.unit_from == "name";
}

// The usual step forward; 0: there is none.
double step_of(const std::vector<double>& time) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (time[i] > time[i - 1]) steps.push_back(time[i] - time[i - 1]);
  }
  return steps.empty() ? 0 : upper_median(std::move(steps));
}

// Of stamps of unknown unit: steps of 0.1 to 20 ms, if they are seconds, are nothing else (a
// fiftieth of a millisecond at most, if they are milliseconds).
bool steps_in_seconds(double step) { return step >= 1e-4 && step < 0.02; }

// Counts from the first stamp on. Stamps since 1970 are so large that a double holds them to a
// fraction of a microsecond: what is left of that is taken off, so that steps are as they were
// written. `parts`: of which a unit has so many that are written in decimals (a day's seconds).
void start_at_zero(std::vector<double>& stamps, double parts) {
  const double first = stamps.front();
  const double spacing = parts * (std::nextafter(first, 2 * first) - first);
  double per_unit = 1;  // steps that are told apart
  while (per_unit * 20 * spacing <= 1) per_unit *= 10;
  double unit = 1;
  while (unit < 2 * spacing) unit *= 10;
  for (double& stamp : stamps) {
    stamp = std::round((stamp - first) * parts / unit * per_unit) / per_unit * unit / parts;
  }
}

// A date with its clock, in words or as a number since a year.
bool holds_clock(const std::string& cell, bool decimal_comma) {
  if (cell.find(':') != std::string::npos) return true;
  double value = 0;
  return read_cell(cell, decimal_comma, value) == CellKind::number &&
         (value != std::floor(value) || value > 1e9) && find_epoch(value, 0, false);
}

}  // namespace

bool completes_time(const CsvLayout& layout, const ColumnPlan& seconds, const ColumnPlan& rest) {
  if (seconds.reading.role != Role::time || seconds.unit.symbol() != "s" ||
      rest.unit.symbol() != "ns") {
    return false;
  }
  constexpr double kSecond = 1e9;  // ns
  const auto place = std::ranges::find(layout.header, rest.reading.column);
  const auto column = static_cast<std::size_t>(place - layout.header.begin());
  return std::ranges::all_of(layout.first_rows, [&](const std::vector<std::string>& row) {
    double value = 0;
    const bool is_number = column < row.size() &&
                           read_cell(row[column], layout.decimal_comma, value) == CellKind::number;
    return !is_number || std::abs(value) < kSecond;
  });
}

std::optional<Epoch> find_epoch(double time, double step, bool in_days) {
  // From 2001 to 2096; rows further apart than minutes are no recording of a motion.
  constexpr double kDay = 86400;
  constexpr double kFirst = 1e9;  // s since 1970
  constexpr double kLast = 4e9;
  constexpr double kLongestStep = 1000;
  const double longest_in_days = in_days ? kLongestStep : 0.1;
  struct Count {
    double scale;
    std::string_view symbol;
    double since_1970;  // s that it began before then
    std::string_view since;
    double longest_step;
  };
  const std::array<Count, 8> counts = {{
      {1, "s", 0, "1970", kLongestStep},
      {1, "ms", 0, "1970", kLongestStep},
      {1, "us", 0, "1970", kLongestStep},
      {1, "ns", 0, "1970", kLongestStep},
      {100, "ns", 134774 * kDay, "1601", kLongestStep},
      {100, "ns", 719162 * kDay, "the year 1", kLongestStep},
      {1, "d", 25569 * kDay, "1900", longest_in_days},
      {1, "d", 719529 * kDay, "the year 0", longest_in_days},
  }};
  for (const Count& count : counts) {
    const Unit* unit = find_unit(count.symbol);
    const double seconds = time * unit->factor * count.scale - count.since_1970;
    if (seconds < kFirst || seconds > kLast) continue;
    if (step * unit->factor * count.scale > count.longest_step) continue;
    return Epoch{{unit, count.scale}, count.since};
  }
  return {};
}

void settle_time(ColumnPlan& plan, std::vector<double>& values, std::string_view place) {
  ColumnReading& reading = plan.reading;
  const double step = step_of(values);
  const bool in_days = plan.unit.unit == find_unit("d");
  const std::optional<Epoch> epoch = find_epoch(values.front(), step, in_days);
  const auto settle = [&](const WrittenUnit& unit, std::string_view from) {
    take_unit(plan, unit, from);
    reading.unit_assumed = false;
    reading.unit_asked = false;
  };
  if (epoch && (plan.unit.unit == nullptr || reading.unit_assumed)) {
    settle(epoch->unit, "size");
  } else if (plan.unit.unit == nullptr && steps_in_seconds(step)) {
    settle({find_unit("s")}, "size of the steps");
  }
  if (plan.unit.unit == nullptr) return;
  if (epoch && plan.unit.unit == epoch->unit.unit && plan.unit.scale == epoch->unit.scale) {
    start_at_zero(values, std::max(1.0, plan.unit.unit->factor));
    reading.remark = fmt::format("since {}; starts at 0 here", epoch->since);
    return;
  }
  if (values.front() * plan.unit.unit->factor * plan.unit.scale > 1e10) {
    throw_bad_input(
        fmt::format("{} {} are more than 300 years", values.front(), plan.unit.symbol()), place,
        !epoch
            ? "check the unit of time"
            : fmt::format("it looks like {} since {}: --roles '{}=time[{}]'", epoch->unit.symbol(),
                          epoch->since, reading.column, epoch->unit.symbol()));
  }
}

bool is_split_stamp(const CsvLayout& layout, const ColumnPlan& plan,
                    const std::vector<ColumnPlan>& plans) {
  return is_named_time(plan, "s") && std::ranges::any_of(plans, [&](const ColumnPlan& other) {
           return is_named_time(other, "ns") && completes_time(layout, plan, other);
         });
}

void take_date(const CsvLayout& layout, std::vector<ColumnPlan>& plans, bool has_time) {
  if (layout.first_rows.empty()) return;  // comments are all that follows the header
  for (std::size_t j = 0; j < plans.size() && !has_time; ++j) {
    ColumnReading& reading = plans[j].reading;
    // A table's index that has no name is often its time.
    const bool may_be_time = names_date(reading.column) || (j == 0 && reading.column == "index");
    if (reading.role != Role::none || plans[j].role_given || !may_be_time) continue;
    const std::vector<std::string>& row = layout.first_rows.front();
    if (j >= row.size() || !holds_clock(row[j], layout.decimal_comma)) continue;
    reading.role = Role::time;
    reading.role_from = "name";
    has_time = true;
  }
}

}  // namespace tribench
