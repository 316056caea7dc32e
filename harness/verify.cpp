// SPDX-License-Identifier: MIT
#include "harness/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "foundation/random.hpp"
#include "harness/provenance.hpp"
#include "harness/run_files.hpp"

namespace tribench {
namespace {

bool is_reproducible(const Record& record) {
  return !is_harmful(record) && record.reason.kind != FailureKind::quarantined &&
         !was_ended_by_clock(record);
}

std::string difference(const CellResult& before, const CellResult& after) {
  const Record& a = before.record;
  const Record& b = after.record;
  if (a.status != b.status || a.reason != b.reason) {
    return fmt::format("{} {} -> {} {}", record_word(a.status), reason_text(a.reason),
                       record_word(b.status), reason_text(b.reason));
  }
  if (a.formula != b.formula) return fmt::format("{} -> {}", a.formula, b.formula);
  if (a.evaluations != b.evaluations) {
    return fmt::format("evaluations {} -> {}", a.evaluations, b.evaluations);
  }
  return "other figures, its front or its trace";
}

}  // namespace

std::vector<std::string> pick_sample(const JournalContents& journal, std::size_t count) {
  std::vector<std::string> cells;
  for (const CellResult& result : journal.results) {
    if (is_reproducible(result.record)) cells.push_back(result.record.cell);
  }
  // The journal's order is that of time; the sample must not depend on it.
  std::ranges::sort(cells);
  RandomStream random(key_of(journal.identity.grid));
  random.shuffle(std::span(cells));
  cells.resize(std::min(count, cells.size()));
  return cells;
}

VerifyResult verify_run(const Grid& grid, const JournalContents& journal, std::size_t count,
                        RunOptions options, const std::atomic<bool>& stop) {
  VerifyResult verdict;
  const std::vector<std::string> sample = pick_sample(journal, count);
  verdict.not_reproducible = static_cast<std::size_t>(std::ranges::count_if(
      journal.results, [](const CellResult& r) { return !is_reproducible(r.record); }));
  if (sample.empty()) return verdict;
  options.only = std::set<std::string>(sample.begin(), sample.end());
  run_grid(grid, options, journal.identity, stop);
  std::map<std::string, const CellResult*> before;
  for (const CellResult& result : journal.results) before[result.record.cell] = &result;
  for (const CellResult& after : read_journal(options.out / "cells.jsonl").results) {
    ++verdict.compared;
    const CellResult& then = *before.at(after.record.cell);
    if (fingerprint(after) != fingerprint(then)) {
      verdict.different.push_back(
          fmt::format("{}: {}", after.record.cell, difference(then, after)));
    }
  }
  std::ranges::sort(verdict.different);
  return verdict;
}

}  // namespace tribench
