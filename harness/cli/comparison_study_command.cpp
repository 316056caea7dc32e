// SPDX-License-Identifier: MIT
//
// tribench study compare: how often `compare` cries without cause, and what it misses.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/study/comparison_study.hpp"
#include "reports/figures.hpp"
#include "reports/statistics/intervals.hpp"

namespace tribench {
namespace {

void print_comparison_study(const std::vector<ComparisonStudyFigure>& figures,
                            const ComparisonStudyOptions& options) {
  fmt::print(
      "Comparisons of made-up runs, {} seeds, 4 problems, 4 methods; two runs of identical code\n"
      "differ by {} % in error and {} % in CPU seconds.\n\n"
      "| planted | comparisons | cried regression | 95 % interval | named the planted method |\n"
      "|---|--:|--:|--:|--:|\n",
      options.seeds, figure(100 * options.run_spread), figure(100 * options.time_spread));
  for (const ComparisonStudyFigure& each : figures) {
    const ConfidenceInterval interval = wilson(each.regressions, each.trials, 0.95);
    fmt::print("| {} | {} | {} | {} .. {} % | {} |\n", each.name, each.trials, each.regressions,
               figure(100 * interval.low), figure(100 * interval.high), each.right);
  }
}

}  // namespace

// Found (exit 1) where identical code cries in more than 1 % of the comparisons or a planted
// regression is missed in more than 5 %.
void add_comparison_study(CLI::App& study, ExitStatus& status) {
  CLI::App* command = study.add_subcommand(
      "compare", "How often does `compare` cry without cause, and miss what was planted?");
  command->footer("Example: tribench study compare --comparisons 200 --seeds 20");
  auto options = std::make_shared<ComparisonStudyOptions>();
  command->add_option("--comparisons", options->comparisons, "of each kind")
      ->transform(whole_number(1, 100000));
  command->add_option("--seeds", options->seeds, "of every run")->transform(whole_number(1, 1000));
  command
      ->add_option("--run-spread", options->run_spread,
                   "how much two runs of identical code differ in error (log)")
      ->transform(real_number(0.0, 1.0));
  command->callback([options, &status] {
    const std::vector<ComparisonStudyFigure> figures = run_comparison_study(*options);
    print_comparison_study(figures, *options);
    const auto trials = static_cast<double>(options->comparisons);
    for (const ComparisonStudyFigure& each : figures) {
      const double share = static_cast<double>(each.regressions) / trials;
      const bool planted = each.name != figures.front().name;
      if (planted ? share < 0.95 : share > 0.01) status = ExitStatus::found;
    }
  });
}

}  // namespace tribench
