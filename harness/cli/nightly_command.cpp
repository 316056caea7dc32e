// SPDX-License-Identifier: MIT
//
// tribench nightly: one night, from the lock to the summary.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/machine.hpp"
#include "harness/nightly.hpp"
#include "harness/shipped_grids.hpp"
#include "problems/measured/data_folder.hpp"

namespace tribench {
namespace {

struct NightlyArguments {
  std::string grid = "nightly";
  std::string data;
  std::string notify;
  int jobs = 0;
  NightlyOptions options;
};

// False where the summary did not reach anybody.
bool notify(const std::string& command, const std::string& summary) {
  constexpr double kPatience_s = 120;
  const ChildRun run =
      run_child({.command = {"sh", "-c", command}}, summary, {kPatience_s, 1U << 20});
  if (run.exit.ok() && !run.timed_out) return true;
  print_message(fmt::format("tribench: --notify: '{}' {}: {}\n", command,
                            run.timed_out ? "took too long" : "failed", run.errors));
  return false;
}

ExitStatus status_of(NightEnd end) {
  switch (end) {
    case NightEnd::fine:
      return ExitStatus::done;
    case NightEnd::regression:
      return ExitStatus::found;
    case NightEnd::undecided:
      return ExitStatus::undecided;
    default:
      return ExitStatus::failed;
  }
}

void run_nightly(NightlyArguments arguments, const Registry& registry, ExitStatus& status) {
  const auto data = measured::find_data_folder(
      arguments.data.empty() ? std::nullopt : std::optional<std::filesystem::path>(arguments.data));
  RunOptions& run = arguments.options.run;
  if (data) run.data = data->string();
  run.jobs = arguments.jobs > 0 ? arguments.jobs : usable_processors();
  run.quiet = true;
  run.worker_command = {"/proc/self/exe", kWorkerCommand};
  const Grid grid = load_named_grid(arguments.grid, registry, full_catalogue(data));
  std::string summary;
  try {
    const NightlyResult night = run_night(grid, arguments.options, stop_requested_by_signal());
    summary = night.summary;
    status = status_of(night.end);
  } catch (const Error& error) {
    // A night that fails before its summary is notified too.
    if (!arguments.notify.empty()) {
      notify(arguments.notify, fmt::format("tribench {}: FAILED\n{}\n", grid.name, error.what()));
    }
    throw;
  }
  fmt::print("{}", summary);
  if (!arguments.notify.empty() && !notify(arguments.notify, summary) &&
      status == ExitStatus::done) {
    status = ExitStatus::failed;
  }
}

}  // namespace

void add_nightly_command(CLI::App& app, ExitStatus& status, const Registry& registry) {
  CLI::App* command = app.add_subcommand(
      "nightly", "One night: runs a grid, verifies, compares with the base, records, tells");
  command->footer(
      "Example: tribench nightly --store /srv/nights --notify 'mail -s tribench team@example.org'\n"
      "Exit status: 0 fine, 1 a regression, 4 undecided, 2 bad input, 3 failed. The base stays "
      "until\n"
      "another night is blessed: tribench history bless STORE REASON.");
  auto arguments = std::make_shared<NightlyArguments>();
  NightlyOptions& options = arguments->options;
  command->add_option("--grid", arguments->grid, "a grid file, or the name of a shipped grid")
      ->capture_default_str();
  command->add_option("--store", options.store, "the folder that keeps the nights")->required();
  command->add_option("--notify", arguments->notify,
                      "a line of shell that gets the summary on its standard input");
  command->add_option("--benches", options.benches,
                      "folder of bench programs that are counted under valgrind and timed");
  command->add_option("--data", arguments->data, "folder of the measured sets");
  command->add_option("--jobs", arguments->jobs, "worker processes at a time (default: all cores)")
      ->transform(whole_number(1, 4096));
  command->add_option("--sample", options.sample, "cells that are run again and must be the same")
      ->transform(whole_number(1, 100'000))
      ->capture_default_str();
  command->add_option("--keep-runs", options.keep_runs, "folders of runs that stay")
      ->transform(whole_number(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--keep-nights", options.keep_nights, "records of nights that stay")
      ->transform(whole_number(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--least-free", options.least_free_mib, "MiB that the disk must have free")
      ->transform(real_number(0, 1e9))
      ->capture_default_str();
  command
      ->add_option("--tolerance", options.tolerance,
                   "a loss beyond this share that is not significant leaves the night undecided")
      ->transform(real_number(0, 10))
      ->capture_default_str();
  command->callback([arguments, &registry, &status] { run_nightly(*arguments, registry, status); });
}

}  // namespace tribench
