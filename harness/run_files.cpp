// SPDX-License-Identifier: MIT
#include "harness/run_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "foundation/error.hpp"
#include "harness/provenance.hpp"
#include "reports/record_csv.hpp"

namespace tribench {

void write_plan_files(const std::filesystem::path& folder, const Grid& grid) {
  std::vector<PlannedCell> planned;
  for (const Cell& cell : grid.cells()) {
    planned.push_back({cell.key(), cell.problem, cell.method, cell.operators, cell.seed});
  }
  write_file(folder / "grid.toml", print_grid(grid));
  write_file(folder / "planned.csv", planned_csv(planned));
}

void write_result_files(const std::filesystem::path& folder, std::vector<CellResult> results) {
  std::ranges::sort(results, [](const CellResult& a, const CellResult& b) {
    return comes_before(a.record, b.record);
  });
  std::vector<Record> records;
  std::vector<FrontRecord> front;
  std::vector<TraceRecord> trace;
  for (CellResult& result : results) {
    records.push_back(std::move(result.record));
    front.insert(front.end(), result.front.begin(), result.front.end());
    trace.insert(trace.end(), result.trace.begin(), result.trace.end());
  }
  write_file(folder / "results.csv", results_csv(std::move(records)));
  write_file(folder / "front.csv", front_csv(front));
  write_file(folder / "trace.csv", trace_csv(trace));
}

JournalContents merge_journals(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& out) {
  JournalContents merged;
  std::map<std::string, std::string> seen;  // cell -> fingerprint
  for (const std::filesystem::path& folder : folders) {
    JournalContents part = read_journal(folder / "cells.jsonl");
    if (folder == folders.front()) merged.identity = part.identity;
    const std::string difference = merged.identity.difference(part.identity);
    if (!difference.empty()) {
      throw_bad_input(fmt::format("these are different runs:\n{}", difference), folder.string(),
                      fmt::format("merge it apart from {}", folders.front().string()));
    }
    for (const std::string& damage : part.damage) {
      merged.damage.push_back(fmt::format("{}: {}", folder.string(), damage));
    }
    for (CellResult& result : part.results) {
      const auto [found, is_new] = seen.try_emplace(result.record.cell, fingerprint(result));
      if (is_new) {
        merged.results.push_back(std::move(result));
      } else if (found->second != fingerprint(result)) {
        throw_bad_input(
            fmt::format("the cell {} has another result in an earlier folder", result.record.cell),
            folder.string(), "one of the two runs is not reproducible: see its note");
      }
    }
  }
  std::ranges::sort(merged.results, [](const CellResult& a, const CellResult& b) {
    return comes_before(a.record, b.record);
  });
  std::filesystem::create_directories(out);
  Journal journal = Journal::create(out / "cells.jsonl", merged.identity);
  for (const CellResult& result : merged.results) journal.append(result);
  return merged;
}

}  // namespace tribench
