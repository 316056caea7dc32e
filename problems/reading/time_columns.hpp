// SPDX-License-Identifier: MIT
//
// Which columns are the time, where more than one sounds like it: seconds and nanoseconds of one
// stamp, a date that holds the clock. What one column says by itself: channel_names.hpp; the order
// of the rows: time_order.hpp.
#pragma once

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

// A date that holds the clock ("2025-03-07T14:58:21.25") is the time where nothing else is.
void take_date(const CsvLayout& layout, std::vector<ColumnPlan>& plans, bool has_time);

}  // namespace tribench
