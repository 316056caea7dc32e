// SPDX-License-Identifier: MIT
//
// tribench compare: is a run better, worse or not distinguishable from another; with a history,
// where it stepped or began to drift.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "foundation/json_text.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/run_files.hpp"
#include "reports/comparison.hpp"
#include "reports/history.hpp"
#include "reports/run_folder.hpp"

namespace tribench {
namespace {

struct CompareArguments {
  std::string base;
  std::string now;
  std::vector<std::string> history;  // oldest first, before `base`
  ComparisonOptions options;
  bool json = false;
};

nlohmann::ordered_json changes_json(const std::vector<SeriesChange>& changes,
                                    const std::vector<RunFolder>& runs) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const SeriesChange& each : changes) {
    const bool step = each.change.kind == Change::Kind::step;
    array.push_back({{"method", each.method},
                     {"operators", each.operators},
                     {"problem", each.problem},
                     {"change", step ? "step" : "drift"},
                     {"since", runs[each.change.at].path.string()},
                     {"ratio", each.change.ratio},
                     {"p", each.change.p}});
  }
  return array;
}

ExitStatus status_of(const Comparison& comparison) {
  switch (comparison.outcome()) {
    case ComparisonOutcome::regression:
      return ExitStatus::found;
    case ComparisonOutcome::undecided:
      return ExitStatus::undecided;
    default:
      return ExitStatus::done;
  }
}

// With its tables as the journal has them where they are behind it, as those of a run that was
// killed.
RunFolder read_whole_run(const std::filesystem::path& folder) {
  const std::filesystem::path journal = folder / "cells.jsonl";
  const std::filesystem::path results = folder / "results.csv";
  if (std::filesystem::exists(journal) &&
      (!std::filesystem::exists(results) ||
       std::filesystem::last_write_time(results) < std::filesystem::last_write_time(journal))) {
    const JournalContents contents = rewrite_result_files(folder);
    for (const std::string& damage : contents.damage) {
      print_message(fmt::format("tribench: {}\n", damage));
    }
  }
  return read_run_folder(folder);
}

void compare(const CompareArguments& arguments, ExitStatus& status) {
  std::vector<RunFolder> runs;
  for (const std::string& folder : arguments.history) runs.push_back(read_whole_run(folder));
  runs.push_back(read_whole_run(arguments.base));
  runs.push_back(read_whole_run(arguments.now));
  const Comparison comparison = compare_runs(runs[runs.size() - 2], runs.back(), arguments.options);
  const bool has_history = !arguments.history.empty();
  const std::vector<SeriesChange> changes =
      has_history ? find_changes(runs) : std::vector<SeriesChange>();
  if (arguments.json) {
    nlohmann::ordered_json answer = comparison_json(comparison);
    if (has_history) answer["history"] = changes_json(changes, runs);
    fmt::print("{}\n", write_json(answer, 2));
  } else {
    fmt::print("{}", comparison_markdown(comparison));
    if (has_history) fmt::print("\n### History\n\n{}", history_markdown(changes, runs));
  }
  status = status_of(comparison);
}

}  // namespace

void add_compare_command(CLI::App& app, ExitStatus& status) {
  CLI::App* command = app.add_subcommand(
      "compare", "Decides whether a run is better, worse or not distinguishable from another");
  command->footer(
      "Exit status: 0 fine, 1 a regression, 4 undecided (the runs were asked different things, "
      "cells "
      "are missing, or a loss beyond the tolerance is not significant).\n"
      "Example: tribench compare runs/yesterday runs/today --history runs/monday runs/tuesday");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("base", arguments->base, "folder of the run to compare with")->required();
  command->add_option("new", arguments->now, "folder of the run in question")->required();
  command->add_option("--history", arguments->history,
                      "earlier runs, oldest first: steps and drifts over all of them");
  command->add_flag("--allow", arguments->options.allow_conditions,
                    "compare though budgets, parameters, seeds or data differ");
  command
      ->add_option("--tolerance", arguments->options.tolerance,
                   "a loss beyond this share that is not significant leaves it undecided")
      ->transform(real_number(0, 10))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "the comparison as JSON");
  command->callback([arguments, &status] { compare(*arguments, status); });
}

}  // namespace tribench
