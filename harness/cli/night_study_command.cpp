// SPDX-License-Identifier: MIT
//
// tribench study nights: how often a nightly job cries without cause, and how soon it finds a loss.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "foundation/error.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/machine.hpp"
#include "harness/nightly.hpp"
#include "harness/shipped_grids.hpp"
#include "harness/study/night_study.hpp"
#include "harness/whole_run.hpp"
#include "problems/measured/data_folder.hpp"
#include "reports/figures.hpp"
#include "reports/statistics/intervals.hpp"

namespace tribench {
namespace {

struct NightStudyArguments {
  std::string folder;
  std::string grid;
  std::string data;
  std::size_t streams = 12;
  int jobs = 0;
  NightStudyOptions study;
};

std::string share_with_interval(std::size_t hits, std::size_t trials) {
  const ConfidenceInterval interval = wilson(hits, trials, 0.95);
  return fmt::format("{} of {}: {:.2f} % ({:.2f} .. {:.2f} %)", hits, trials,
                     100.0 * static_cast<double>(hits) / static_cast<double>(trials),
                     100 * std::max(0.0, interval.low), 100 * interval.high);
}

void print_false_alarms(const NightStudy& study) {
  const FalseAlarms& pairs = study.pairs;
  const FalseAlarms& nights = study.sequences;
  const auto line = [](const char* what, std::size_t hits, std::size_t asked, double allowed) {
    fmt::print("| {} | {} | {:.2f} % |\n", what, share_with_interval(hits, asked), 100 * allowed);
  };
  fmt::print("| identical code | nights that cry (95 % interval) | allowed |\n|---|---|---|\n");
  line("pairs: the comparison with the base", pairs.by_comparison, pairs.asked,
       pairs.allowed_a_night - nights.allowed_a_night);
  line("pairs: tests over nights", pairs.by_nights, pairs.asked, nights.allowed_a_night);
  line("nights after a base: tests over nights", nights.by_nights, nights.asked,
       nights.allowed_a_night);
  fmt::print(
      "\nUndecided (a loss beyond the tolerance that is not significant): pairs {}; nights that\n"
      "have {} before them {}.\n",
      share_with_interval(pairs.undecided, pairs.asked), kNightsThatSettle,
      share_with_interval(nights.undecided, nights.undecided_asked));
}

// One line for each series and number of nights before; a cell has the shares of three nights.
void print_detections(const NightStudy& study) {
  std::map<std::tuple<std::string, std::string, std::size_t>, std::map<std::string, std::string>>
      lines;
  std::set<std::string> columns;
  for (const Detection& each : study.detections) {
    const auto percent = [&](std::size_t k) {
      return fmt::format(
          "{:.0f}", 100.0 * static_cast<double>(each.found[k]) / static_cast<double>(each.trials));
    };
    const std::string column =
        fmt::format("{}{:2.0f} %", each.creep ? "creep" : "", 100 * each.loss);
    columns.insert(column);
    lines[{each.problem, each.method, each.before}][column] =
        fmt::format("{} / {} / {}", percent(0), percent(1), percent(2));
  }
  fmt::print(
      "\nFound, in % of the trials, by the first / third / seventh night with a loss, by the\n"
      "third / fifth / seventh with a creep (that much each night).\n\n"
      "| in | spread between streams | nights before |");
  for (const std::string& column : columns) fmt::print(" {} |", column);
  fmt::print("\n|---|--:|--:|");
  for (std::size_t k = 0; k < columns.size(); ++k) fmt::print("--:|");
  fmt::print("\n");
  for (const auto& [key, cells] : lines) {
    const auto& [problem, method, before] = key;
    std::string spread;
    for (const StreamSeries& series : study.series) {
      if (series.problem != problem || series.method != method) continue;
      spread = fmt::format("{:.1f} %", 100 * series.spread);
    }
    fmt::print("| {} | {} | {} |",
               problem.empty() ? "any series that draws" : fmt::format("{} on {}", method, problem),
               spread, before);
    for (const std::string& column : columns) {
      const auto found = cells.find(column);
      fmt::print(" {} |", found == cells.end() ? "" : found->second);
    }
    fmt::print("\n");
  }
}

// False where it was asked to stop.
bool run_streams(const NightStudyArguments& arguments, const Registry& registry) {
  const auto data = measured::find_data_folder(
      arguments.data.empty() ? std::nullopt : std::optional<std::filesystem::path>(arguments.data));
  RunOptions run;
  run.out = arguments.folder;
  run.resume = true;
  if (data) run.data = data->string();
  run.jobs = arguments.jobs > 0 ? arguments.jobs : usable_processors();
  run.worker_command = {"/proc/self/exe", kWorkerCommand};
  const Grid grid = grid_of_streams(load_named_grid(arguments.grid, registry, full_catalogue(data)),
                                    arguments.streams);
  return !run_whole(grid, run, stop_requested_by_signal()).tally.stopped;
}

void study_nights(const NightStudyArguments& arguments, const Registry& registry,
                  ExitStatus& status) {
  if (!arguments.grid.empty() && !run_streams(arguments, registry)) {
    status = ExitStatus::failed;
    return;
  }
  const NightStudy study = run_night_study(read_run_folder(arguments.folder), arguments.study);
  print_false_alarms(study);
  print_detections(study);
  // Found: what was allowed lies below the interval of what was seen.
  const auto too_many = [](std::size_t hits, std::size_t asked, double allowed) {
    return wilson(hits, asked, 0.95).low > allowed;
  };
  const FalseAlarms& pairs = study.pairs;
  const FalseAlarms& nights = study.sequences;
  if (too_many(pairs.by_comparison + pairs.by_nights, pairs.asked, pairs.allowed_a_night) ||
      too_many(nights.by_nights, nights.asked, nights.allowed_a_night)) {
    status = ExitStatus::found;
  }
}

}  // namespace

void add_night_study(CLI::App& study, ExitStatus& status, const Registry& registry) {
  CLI::App* command = study.add_subcommand(
      "nights",
      "How often does a nightly job cry without cause, and how soon does it find a loss?");
  command->footer(
      "Example: tribench study nights streams --grid examples/nightly/streams.toml\n"
      "Runs every method of the grid with several streams of random numbers (what is there "
      "already\n"
      "is not run again), then draws nights from them. Exit status: 1 where it cries more often\n"
      "than is allowed.");
  auto arguments = std::make_shared<NightStudyArguments>();
  NightStudyOptions& options = arguments->study;
  command->add_option("DIR", arguments->folder, "folder of the run with streams")->required();
  command->add_option("--grid", arguments->grid,
                      "a grid file or a shipped grid to make that run of (default: it is there)");
  command->add_option("--streams", arguments->streams, "of each method")
      ->transform(whole_number(2, 1000))
      ->capture_default_str();
  command->add_option("--data", arguments->data, "folder of the measured sets");
  command->add_option("--jobs", arguments->jobs, "worker processes and threads at a time")
      ->transform(whole_number(1, 4096));
  const auto count = [&](const char* name, std::size_t& value, const char* text, int least) {
    command->add_option(name, value, text)
        ->transform(whole_number(least, 1'000'000))
        ->capture_default_str();
  };
  count("--pairs", options.pairs, "of a base and a night of identical code", 1);
  count("--sequences", options.sequences, "of nights of identical code", 1);
  count("--nights", options.nights, "of a sequence", 1);
  count("--trials", options.trials, "of each planted loss", 1);
  count("--before", options.before, "harmless nights before a planted loss", 0);
  command->callback([arguments, &registry, &status] {
    arguments->study.threads = arguments->jobs;
    study_nights(*arguments, registry, status);
  });
}

}  // namespace tribench
