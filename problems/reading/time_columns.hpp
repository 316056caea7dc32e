// SPDX-License-Identifier: MIT
//
// Which columns are the time, where more than one sounds like it: seconds and nanoseconds of one
// stamp, a date that holds the clock; and the unit of a time by the size of its stamps. What one
// column says by itself: channel_names.hpp; the order of the rows: time_order.hpp.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "problems/reading/column_plan.hpp"
#include "problems/reading/csv_layout.hpp"

namespace tribench {

// Seconds and nanoseconds of one stamp in two columns: the rows that are seen have less than a
// second of the second.
bool completes_time(const CsvLayout& layout, const ColumnPlan& seconds, const ColumnPlan& rest);

// Seconds beside their nanoseconds, both named so, are a stamp before any other column that sounds
// like a time: a recorder's own time beside the message's.
bool is_split_stamp(const CsvLayout& layout, const ColumnPlan& plan,
                    const std::vector<ColumnPlan>& plans);

// A time that counts since a year, by its size.
struct Epoch {
  WrittenUnit unit;
  std::string_view since;  // "1970"
};

// Of stamps that go on by `step`: since 1970 (s, ms, us, ns), 1601 or the year 1 (100 ns, Windows
// and .NET), 1900 or the year 0 (days, as spreadsheets and MATLAB's datenum count). `in_days`: the
// unit is told, and it is days; else days are only what goes on by less than a tenth of a second.
std::optional<Epoch> find_epoch(double time, double step, bool in_days);

// Settles the unit of time by what the values say; time since a year starts at 0. Throws Error
// (bad_input) where it would be more than 300 years.
void settle_time(ColumnPlan& plan, std::vector<double>& values, std::string_view place);

// A date that holds the clock ("2025-03-07T14:58:21.25") is the time where nothing else is.
void take_date(const CsvLayout& layout, std::vector<ColumnPlan>& plans, bool has_time);

}  // namespace tribench
