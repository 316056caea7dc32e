// SPDX-License-Identifier: MIT
//
// The files of a run that hold records: results.csv (one cell a row), front.csv (one formula of a
// cell's front a row), trace.csv (one improvement a row), curves.csv (one point of a picture a
// row) and planned.csv (the cells the grid asks for). Their columns are in record_columns.hpp.
//
// Rows of results.csv are sorted by problem, method, operator set and seed, so that the same cells
// give the same file whatever the order they ended in. A column that a reader does not know is
// skipped, a column that is missing leaves its figures missing; only `cell` is required.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "reports/csv.hpp"
#include "reports/record/record.hpp"

namespace tribench {

// The text of the file; results are sorted first (see above), the others are written as given.
std::string results_csv(std::vector<Record> records);
std::string front_csv(const std::vector<FrontRecord>& records);
std::string trace_csv(const std::vector<TraceRecord>& records);
std::string curves_csv(const std::vector<CurveRecord>& records);
std::string planned_csv(const std::vector<PlannedCell>& cells);

// Reads a file row by row. Throws Error (bad_input) where the file cannot be opened or has no
// column `cell`; damaged rows are complained of in the result. A field that should be a number and
// is none drops its row.
CsvReading read_results(const std::filesystem::path& file,
                        const std::function<void(Record&&)>& take);
CsvReading read_front(const std::filesystem::path& file,
                      const std::function<void(FrontRecord&&)>& take);
CsvReading read_trace(const std::filesystem::path& file,
                      const std::function<void(TraceRecord&&)>& take);
CsvReading read_curves(const std::filesystem::path& file,
                       const std::function<void(CurveRecord&&)>& take);
CsvReading read_planned(const std::filesystem::path& file,
                        const std::function<void(PlannedCell&&)>& take);

// The order of results.csv.
bool comes_before(const Record& a, const Record& b);

}  // namespace tribench
