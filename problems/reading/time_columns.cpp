// SPDX-License-Identifier: MIT
#include "problems/reading/time_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_cells.hpp"

namespace tribench {
namespace {

bool is_named_time(const ColumnPlan& plan, std::string_view unit) {
  const ColumnReading& reading = plan.reading;
  return reading.role == Role::time && plan.unit.symbol() == unit && reading.unit_from == "name";
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

bool is_split_stamp(const CsvLayout& layout, const ColumnPlan& plan,
                    const std::vector<ColumnPlan>& plans) {
  return is_named_time(plan, "s") && std::ranges::any_of(plans, [&](const ColumnPlan& other) {
           return is_named_time(other, "ns") && completes_time(layout, plan, other);
         });
}

void take_date(const CsvLayout& layout, std::vector<ColumnPlan>& plans, bool has_time) {
  for (std::size_t j = 0; j < plans.size() && !has_time; ++j) {
    ColumnReading& reading = plans[j].reading;
    if (reading.role != Role::none || plans[j].role_given || !names_date(reading.column)) continue;
    const std::vector<std::string>& row = layout.first_rows.front();
    if (j >= row.size() || row[j].find(':') == std::string::npos) continue;
    reading.role = Role::time;
    reading.role_from = "name";
    has_time = true;
  }
}

}  // namespace tribench
