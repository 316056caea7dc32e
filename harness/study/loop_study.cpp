// SPDX-License-Identifier: MIT
#include "harness/study/loop_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <optional>

#include "foundation/error.hpp"
#include "harness/study/each_case.hpp"
#include "harness/study/runs_file.hpp"

namespace tribench {
namespace {

double thread_cpu_s() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

LoopOutcome run_case(const LoopCase& one, const LoopMethod& method) {
  const PlantedData planted = one.make();
  const double start_s = thread_cpu_s();
  const LoopAnswer answer = method(one, planted);
  const double cpu_s = thread_cpu_s() - start_s;
  LoopOutcome out = judge_answer(one, answer, planted);
  out.cpu_s = cpu_s;
  if (one.group == "null") {
    out.naive = test_naively(loop::observe(planted.data), one.gear_ratio);
  }
  return out;
}

RunFormat<LoopOutcome> outcome_format() {
  return {{kOutcomeColumns.begin(), kOutcomeColumns.end()},
          outcome_row,
          read_outcome,
          [](const LoopOutcome& one) { return one.key; }};
}

}  // namespace

LoopStudy run_loop_study(const LoopStudyOptions& options, const LoopMethod& method) {
  const bool simulated = options.generator == LoopGenerator::simulated;
  std::vector<LoopCase> cases = (simulated ? make_simulated_cases : make_loop_cases)(
      options.null_runs, options.runs_per_cell, options.first_seed);
  std::erase_if(cases, [&](const LoopCase& one) { return !one.key().starts_with(options.only); });
  if (cases.empty()) {
    throw_bad_input(fmt::format("no case begins with '{}'", options.only), "--only",
                    "as in runs.csv: single/stribeck, null, pair");
  }
  const std::filesystem::path file = options.out.empty() ? options.out : options.out / "runs.csv";
  RunsFile<LoopOutcome> runs(file, outcome_format());
  LoopStudy study;
  study.outcomes.resize(cases.size());
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (std::optional<LoopOutcome> known = runs.done(cases[i].key())) {
      study.outcomes[i] = std::move(*known);
    } else {
      left.push_back(i);
    }
  }
  for_each_case(left.size(), options.threads, options.quiet, [&](std::size_t k) {
    LoopOutcome& outcome = study.outcomes[left[k]];
    outcome = run_case(cases[left[k]], method);
    runs.append(outcome);
  });
  study.figures = simulated ? simulated_figures(study.outcomes) : loop_figures(study.outcomes);
  if (simulated) study.answers = cause_answers(study.outcomes);
  return study;
}

}  // namespace tribench
