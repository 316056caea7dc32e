// SPDX-License-Identifier: MIT
//
// The CSV files of a run's folder, whole or damaged: what is read of results.csv is written as a
// file that reads the same; the others are read without harm.
#include "reports/published.hpp"
#include "reports/record/record_csv.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

std::vector<Record> results_of(std::string_view text) {
  const fuzz::MemoryFile file(text);
  std::vector<Record> records;
  read_results(file.path(), [&](Record&& record) { records.push_back(std::move(record)); });
  return records;
}

template <typename Row, typename Reader>
void read_all(const std::string& file, Reader reader) {
  fuzz::reads([&] { reader(file, [](Row&&) {}); });
}

}  // namespace

TRIBENCH_FUZZ_TARGET(records) {
  const fuzz::MemoryFile file(input);
  std::vector<Record> records;
  if (fuzz::reads([&] { records = results_of(input); })) {
    const std::string written = results_csv(records);
    fuzz::expect(results_csv(results_of(written)) == written,
                 "what is written reads as something else:\n" + written);
  }
  read_all<FrontRecord>(file.path(), read_front);
  read_all<TraceRecord>(file.path(), read_trace);
  read_all<CurveRecord>(file.path(), read_curves);
  read_all<PlannedCell>(file.path(), read_planned);
  std::vector<std::string> complaints;
  read_published(file.path(), complaints);
  fuzz::reads([&] { check_published(std::string(input), "reference.csv"); });
}
