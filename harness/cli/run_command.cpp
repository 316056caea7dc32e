// SPDX-License-Identifier: MIT
//
// tribench run: a grid from start to leaderboard.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/text.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/curves.hpp"
#include "harness/grid.hpp"
#include "harness/machine.hpp"
#include "harness/plan.hpp"
#include "harness/provenance.hpp"
#include "harness/run.hpp"
#include "harness/run_files.hpp"
#include "harness/shipped_grids.hpp"
#include "harness/verify.hpp"
#include "problems/measured/data_folder.hpp"
#include "reports/record_csv.hpp"
#include "reports/run_reports.hpp"

namespace tribench {
namespace {

struct RunArguments {
  std::string grid = "quick";
  std::string out;
  std::string data;
  std::string shard = "1/1";
  int jobs = 0;
  bool resume = false;
  bool dry_run = false;
  bool timing = false;
  bool quiet = false;
  bool json = false;
  std::string quarantine;
  std::string verify;
  std::size_t sample = 10;
};

void print_dry_run(const Grid& grid, const std::vector<PlannedWork>& work, int jobs, bool json) {
  double total_s = 0;
  nlohmann::json cells = nlohmann::json::array();
  for (const PlannedWork& item : work) {
    total_s += item.predicted_s;
    if (json) {
      cells.push_back({{"cell", item.cell.key()}, {"predicted_s", item.predicted_s}});
    } else {
      fmt::print("{:8.2f} s  {}\n", item.predicted_s, item.cell.key());
    }
  }
  const double wall_s = total_s / jobs;
  if (json) {
    fmt::print("{}\n", nlohmann::json{{"grid", grid.name},
                                      {"cells", cells},
                                      {"predicted_cpu_s", total_s},
                                      {"predicted_wall_s", wall_s}}
                           .dump(2));
  } else {
    fmt::print("{} cells, about {:.0f} CPU seconds, {:.0f} s with {} jobs\n", work.size(), total_s,
               wall_s, jobs);
  }
}

// As it was typed, words separated by blanks.
std::string own_command_line() {
  std::string text = read_file_if_there("/proc/self/cmdline").value_or("");
  if (!text.empty()) text.pop_back();
  std::ranges::replace(text, '\0', ' ');
  return text;
}

void print_end(const RunTally& tally, const std::filesystem::path& out, const std::string& board) {
  if (!board.empty()) fmt::print("{}\n", board);
  for (const std::string& damage : tally.journal_damage) {
    fmt::print(stderr, "tribench: cells.jsonl: {}\n", damage);
  }
  if (tally.stopped) {
    fmt::print(stderr,
               "stopped: {} of {} cells are done; go on by: tribench run ... --out {} --resume\n",
               tally.done(), tally.cells, out.string());
  } else {
    fmt::print("{} cells, {} failed, {:.1f} s; see {}\n", tally.done(), tally.failed, tally.wall_s,
               (out / "leaderboard.md").string());
  }
}

void run_to_the_end(const Grid& grid, const RunOptions& options, ExitStatus& status) {
  const RunIdentity identity{print_grid(grid), code_identity(), data_identity(grid, options.data)};
  // A full disk or a limit on file sizes is an error of write(), not a reason to die.
  std::signal(SIGXFSZ, SIG_IGN);
  // The first signal lets the run close its files.
  const std::atomic<bool>& stop = stop_requested_by({SIGINT, SIGTERM});
  RunSession session{utc_now(), {}, own_command_line(), options, {}};
  session.tally = run_grid(grid, options, identity, stop);
  session.ended = utc_now();
  const JournalContents journal = read_journal(options.out / "cells.jsonl");
  write_result_files(options.out, journal.results);
  write_curves(options.out, journal.results, full_catalogue_of(options.data));
  write_quarantine_file(options.out, journal.results);
  write_provenance(options.out, identity, session, journal.results);
  print_end(session.tally, options.out, write_run_reports(options.out));
  if (session.tally.stopped) status = ExitStatus::failed;
}

RunOptions options_of(const RunArguments& arguments) {
  RunOptions options;
  const auto data = measured::find_data_folder(
      arguments.data.empty() ? std::nullopt : std::optional<std::filesystem::path>(arguments.data));
  if (data) options.data = data->string();
  options.shard = parse_shard(arguments.shard);
  options.resume = arguments.resume;
  options.quiet = arguments.quiet;
  options.pin = arguments.timing;
  const int processors = usable_processors();
  options.jobs = arguments.jobs > 0 ? arguments.jobs
                 : arguments.timing ? std::max(1, processors - 1)
                                    : processors;
  options.worker_command = {"/proc/self/exe", kWorkerCommand};
  return options;
}

void verify(const RunArguments& arguments, const Registry& registry, ExitStatus& status) {
  const std::filesystem::path folder = arguments.verify;
  RunOptions options = options_of(arguments);
  const JournalContents journal = read_journal(folder / "cells.jsonl");
  const Grid grid = load_grid(folder / "grid.toml", registry, full_catalogue_of(options.data));
  const ScratchFolder scratch;
  options.out = scratch.path() / "run";
  const std::atomic<bool> never{false};
  const VerifyResult verdict = verify_run(grid, journal, arguments.sample, options, never);
  if (journal.identity.code != code_identity()) {
    fmt::print("made by {}, verified by {}\n", journal.identity.code, code_identity());
  }
  for (const std::string& difference : verdict.different) fmt::print("{}\n", difference);
  fmt::print("{} cells run again, {} differ; {} cells of the run promise nothing (clock, limits)\n",
             verdict.compared, verdict.different.size(), verdict.not_reproducible);
  if (!verdict.different.empty()) status = ExitStatus::found;
}

void run(const RunArguments& arguments, const Registry& registry, ExitStatus& status) {
  if (!arguments.verify.empty()) {
    verify(arguments, registry, status);
    return;
  }
  RunOptions options = options_of(arguments);
  Grid grid = load_named_grid(arguments.grid, registry, full_catalogue_of(options.data));
  if (!arguments.quarantine.empty()) {
    for (std::string& glob : read_quarantine_file(arguments.quarantine)) {
      grid.quarantine.push_back(std::move(glob));
    }
  }
  if (arguments.dry_run) {
    print_dry_run(grid, plan_work(grid, options.shard), options.jobs, arguments.json);
    if (arguments.out.empty()) return;
    std::filesystem::create_directories(arguments.out);
    write_plan_files(arguments.out, grid);
    return;
  }
  options.out = arguments.out.empty() ? fmt::format("run-{}", grid.name) : arguments.out;
  run_to_the_end(grid, options, status);
}

}  // namespace

void add_run_command(CLI::App& app, ExitStatus& status, const Registry& registry) {
  CLI::App* command = app.add_subcommand("run", "Runs a grid of cells and renders a leaderboard");
  command->footer(
      "Example: tribench run grids/paper.toml --out run-paper --jobs 8\n"
      "Without a file the built-in grid 'quick' runs. Ctrl-C leaves a run that --resume goes on "
      "with.");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("grid", arguments->grid, "a grid file, or a name of `tribench list grids`")
      ->capture_default_str();
  command->add_option("--out", arguments->out, "the run's folder (default: run-NAME)");
  command->add_option("--jobs", arguments->jobs, "worker processes at a time (default: all cores)")
      ->transform(whole_number(1, 4096));
  command->add_option("--shard", arguments->shard, "K/N: the K-th of N parts of the grid");
  command->add_option("--data", arguments->data, "folder of the measured sets");
  command->add_flag("--resume", arguments->resume, "run what the folder does not have yet");
  command->add_flag("--dry-run", arguments->dry_run,
                    "only list the cells and what they are predicted to cost");
  command->add_flag("--timing", arguments->timing,
                    "for times to compare: one core is left free, workers are pinned");
  command->add_option("--quarantine", arguments->quarantine,
                      "a file of cells (globs, one a line) that are not run");
  command->add_option("--verify", arguments->verify,
                      "run some cells of this finished run again and compare them bit for bit");
  command->add_option("--sample", arguments->sample, "with --verify: how many cells")
      ->transform(whole_number(1))
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "no progress line");
  command->add_flag("--json", arguments->json, "with --dry-run: as JSON");
  command->callback([arguments, &registry, &status] { run(*arguments, registry, status); });
}

}  // namespace tribench
