// SPDX-License-Identifier: MIT
#include "harness/run_files.hpp"

#include <fmt/format.h>
#include <sstream>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <unordered_set>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/text.hpp"
#include "harness/provenance.hpp"
#include "problems/variant.hpp"
#include "reports/published.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/suite_view.hpp"

namespace tribench {

namespace {

int nodes_of(const std::string& law) {
  std::vector<std::string> names;
  return static_cast<int>(parse_collecting_names(law, names).size());
}

// What reports have to know of the suites in a grid.
std::string suite_text(const Grid& grid) {
  std::vector<SuiteInfo> suites;
  for (const suite::Suite& suite : grid.suites) {
    SuiteInfo info;
    info.name = suite.name;
    info.summary = suite.summary;
    info.recovered_below = suite.recovered_below;
    info.reference_note = suite.reference_note;
    for (const suite::SuiteProblem& problem : suite.problems) {
      const std::string name = fmt::format("{}/{}", suite.name, problem.name);
      const int nodes = problem.law.empty() ? 0 : nodes_of(problem.law);
      info.problems.push_back({name, problem.law, nodes});
      for (const std::string& other : grid.problems) {
        if (other != name && split_variant(other).first == name) {
          info.problems.push_back({other, problem.law, nodes});
        }
      }
    }
    for (const suite::SuiteReference& one : suite.references) {
      info.references.push_back({one.method, one.seconds, one.recovered, one.low, one.high});
    }
    for (const suite::PublishedResult& one : suite.results) {
      info.results.push_back({fmt::format("{}/{}", suite.name, one.dataset), one.method,
                              one.symbolic, one.r2, one.seconds});
    }
    info.results_note = suite.published.note;
    if (suite.results.empty() && !suite.published.file.empty()) {
      info.results_note = fmt::format(
          "Published results would stand here if the folder of data had {}.", suite.published.file);
    }
    suites.push_back(std::move(info));
  }
  return suites_json(suites);
}

}  // namespace

void write_plan_files(const std::filesystem::path& folder, const Grid& grid) {
  std::vector<PlannedCell> planned;
  for (const Cell& cell : grid.cells()) {
    planned.push_back({cell.key(), cell.problem, cell.method, cell.operators, cell.seed});
  }
  write_file(folder / "grid.toml", print_grid(grid, folder));
  write_file(folder / "planned.csv", planned_csv(planned));
  if (!grid.reference.empty()) write_file(folder / kPublishedFile, grid.reference);
  if (!grid.suites.empty()) write_file(folder / kSuiteFile, suite_text(grid));
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

JournalContents rewrite_result_files(const std::filesystem::path& folder) {
  JournalContents journal = read_journal(folder / "cells.jsonl");
  write_result_files(folder, journal.results);
  return journal;
}

bool is_harmful(const Record& record) {
  return is_limit(record.reason.kind) || record.reason.kind == FailureKind::crashed;
}

void write_quarantine_file(const std::filesystem::path& folder,
                           const std::vector<CellResult>& results) {
  std::vector<std::string> cells;
  for (const CellResult& result : results) {
    if (is_harmful(result.record)) cells.push_back(result.record.cell);
  }
  std::ranges::sort(cells);
  const std::filesystem::path file = folder / "quarantine.txt";
  if (cells.empty()) {
    std::filesystem::remove(file);
  } else {
    write_file(file, fmt::format("{}\n", fmt::join(cells, "\n")));
  }
}

std::vector<std::string> read_quarantine_file(const std::filesystem::path& file) {
  std::istringstream stream(read_file(file));
  std::vector<std::string> globs;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line.front() != '#') globs.push_back(line);
  }
  return globs;
}

JournalContents merge_journals(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& out) {
  if (std::filesystem::exists(out / "cells.jsonl")) {
    throw_bad_input("there is a run in this folder already", (out / "cells.jsonl").string(),
                    "give another --out, or remove this run first");
  }
  JournalContents merged;
  std::set<std::filesystem::path> named;
  std::map<std::string, std::string> seen;  // cell -> fingerprint
  for (const std::filesystem::path& folder : folders) {
    JournalContents part = read_journal(folder / "cells.jsonl");
    if (!named.insert(std::filesystem::weakly_canonical(folder / "cells.jsonl")).second) {
      throw_bad_input("this folder is named twice", folder.string(), "name each shard once");
    }
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
      } else {
        ++merged.repeated;
      }
    }
  }
  std::ranges::sort(merged.results, [](const CellResult& a, const CellResult& b) {
    return comes_before(a.record, b.record);
  });
  make_output_folder(out);
  Journal journal = Journal::create(out / "cells.jsonl", merged.identity);
  for (const CellResult& result : merged.results) journal.append(result);
  return merged;
}

PlannedAndMissing missing_cells(const std::filesystem::path& folder,
                                const std::vector<CellResult>& results) {
  std::unordered_set<std::string_view> done;
  for (const CellResult& result : results) done.insert(result.record.cell);
  PlannedAndMissing cells;
  read_planned(folder / "planned.csv", [&](PlannedCell&& planned) {
    ++cells.planned;
    if (!done.contains(planned.cell)) cells.missing.push_back(std::move(planned.cell));
  });
  return cells;
}

}  // namespace tribench
