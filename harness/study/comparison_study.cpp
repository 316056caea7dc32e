// SPDX-License-Identifier: MIT
#include "harness/study/comparison_study.hpp"

#include <fmt/format.h>

#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"
#include "reports/comparison.hpp"
#include "reports/run_folder.hpp"

namespace tribench {
namespace {

constexpr const char* kPlantedMethod = "b";

struct Planted {
  const char* name;
  double error = 1;  // factor on the planted method's error
  double time = 1;   // factor on its CPU seconds
};

constexpr Planted kPlanted[] = {
    {"identical code"}, {"one method 3 % worse", 1.03, 1}, {"one method 10 % slower", 1, 1.10}};

RunFolder made_up_run(const std::string& name, const ComparisonStudyOptions& options,
                      const Planted& planted) {
  RunFolder run;
  run.path = name;
  run.provenance = {{"sessions.0.machine.cpu", "made up"},
                    {"sessions.0.calibration.samples.0.cpu_s", "0.02"},
                    {"sessions.0.calibration.samples.1.cpu_s", "0.02"}};
  for (const std::string problem : {"p1", "p2", "p3", "p4"}) {
    for (const std::string method : {"a", "b", "c", "d"}) {
      for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
        Record record;
        record.problem = problem;
        record.method = method;
        record.operators = std::string("paper");
        record.seed = seed;
        record.cell = fmt::format("{}|{}|paper|{}", problem, method, seed);
        record.status = CellStatus::ok;
        record.formula = std::string("v");
        RandomStream own(key_of(record.cell));
        RandomStream noise(key_of(record.cell + name));
        const bool is_planted = method == kPlantedMethod;
        record.mae_test = elementary::exp(options.seed_spread * own.normal() +
                                          options.run_spread * noise.normal()) *
                          (is_planted ? planted.error : 1);
        record.fit_cpu_s =
            elementary::exp(options.time_spread * noise.normal()) * (is_planted ? planted.time : 1);
        run.records.push_back(record);
      }
    }
  }
  return run;
}

// Whether every worse verdict, and there is one, is on the planted method.
bool names_the_planted(const Comparison& comparison) {
  bool any = false;
  for (const auto* rows : {&comparison.quality, &comparison.cost}) {
    for (const ComparisonRow& row : *rows) {
      if (row.verdict != ComparisonVerdict::worse) continue;
      if (row.method != kPlantedMethod) return false;
      any = true;
    }
  }
  return any;
}

}  // namespace

std::vector<ComparisonStudyFigure> run_comparison_study(const ComparisonStudyOptions& options) {
  std::vector<ComparisonStudyFigure> figures;
  ComparisonOptions comparing;
  comparing.power_rounds = 0;
  comparing.rounds = 400;  // the interval decides only what is called equivalent
  for (const Planted& planted : kPlanted) {
    ComparisonStudyFigure figure;
    figure.name = planted.name;
    figure.trials = options.comparisons;
    for (std::size_t trial = 0; trial < options.comparisons; ++trial) {
      const RunFolder base = made_up_run(fmt::format("base {}", trial), options, {"base"});
      const RunFolder now = made_up_run(fmt::format("new {}", trial), options, planted);
      const Comparison comparison = compare_runs(base, now, comparing);
      if (!comparison.has_regression()) continue;
      ++figure.regressions;
      if (names_the_planted(comparison)) ++figure.right;
    }
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace tribench
