// SPDX-License-Identifier: MIT
//
// Rows of results as JSON objects, one key a column (record_columns.hpp): what a worker answers and
// the journal keeps. Figures that do not exist are null. Of fronts and traces the cell's key is
// left out: they stand beside the record, which has it.
//
// Reading throws Error (failed) naming the key where a word is none of the column's, and nlohmann's
// exceptions where a key is missing or its value of another kind.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reports/record/record.hpp"

namespace tribench {

nlohmann::json record_json(const Record& record);
nlohmann::json front_json(const FrontRecord& front);
nlohmann::json trace_json(const TraceRecord& trace);

Record parse_record(const nlohmann::json& object);
FrontRecord parse_front(const nlohmann::json& object, const std::string& cell);
TraceRecord parse_trace(const nlohmann::json& object, const std::string& cell);

// The values of the named columns, in their order: a row of a page's table. null where there is
// none.
nlohmann::ordered_json record_row(const Record& record, const std::vector<std::string>& columns);

}  // namespace tribench
