// SPDX-License-Identifier: MIT
//
// tribench run: a grid from start to leaderboard.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/shell_word.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/data_grid_options.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/cli/run_pictures.hpp"
#include "harness/grid.hpp"
#include "harness/machine.hpp"
#include "harness/plan.hpp"
#include "harness/program_files.hpp"
#include "harness/provenance.hpp"
#include "harness/run.hpp"
#include "harness/run_files.hpp"
#include "harness/shipped_grids.hpp"
#include "harness/verify.hpp"
#include "harness/whole_run.hpp"
#include "problems/measured/data_folder.hpp"
#include "reports/picture_files.hpp"
#include "reports/run_folder.hpp"

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
  std::string like;
  std::string pictures;
  std::size_t sample = 10;
  std::shared_ptr<DataGridRequest> own = std::make_shared<DataGridRequest>();
  // In place of the grid's.
  std::optional<std::uint64_t> seeds;
  std::optional<std::uint64_t> evaluations;
  std::optional<double> seconds;

  // Whether the grid's file alone does not say what runs.
  bool changes_grid() const { return !own->files.empty() || seeds || evaluations || seconds; }
};

// What the figure rests on is said with it: without a run to go by it is what budgets allow at
// most.
void print_dry_run(const Grid& grid, const RunArguments& arguments, const RunOptions& options) {
  std::size_t count = 0;
  double total_s = 0;
  // Without a run to go by nothing is predicted.
  const auto predicted = [&](double seconds) {
    return options.costs.empty() ? nlohmann::json() : nlohmann::json(seconds);
  };
  nlohmann::json cells = nlohmann::json::array();
  for_each_planned(grid, options.shard, options.costs, [&](const PlannedWork& item) {
    count += 1;
    total_s += item.predicted_s;
    if (arguments.json) {
      cells.push_back({{"cell", item.cell.key()}, {"predicted_s", predicted(item.predicted_s)}});
    } else {
      fmt::print("{:8.2f} s  {}\n", item.predicted_s, item.cell.key());
    }
  });
  double most_s = 0;
  for_each_planned(grid, options.shard, {},
                   [&](const PlannedWork& item) { most_s += item.predicted_s; });
  const std::string basis =
      options.costs.empty() ? std::string("budgets") : "medians of " + arguments.like;
  if (arguments.json) {
    fmt::print("{}\n",
               write_json(nlohmann::json{{"grid", grid.name},
                                         {"cells", std::move(cells)},
                                         {"basis", basis},
                                         {"predicted_cpu_s", predicted(total_s)},
                                         {"predicted_wall_s", predicted(total_s / options.jobs)},
                                         {"most_wall_s", most_s / options.jobs}},
                          2));
    return;
  }
  if (options.costs.empty()) {
    fmt::print(
        "{} cells, at most {:.0f} s with {} jobs: what their budgets allow. Most methods end long\n"
        "before; for an estimate name a run to go by: --like DIR\n",
        count, total_s / options.jobs, options.jobs);
  } else {
    fmt::print("{} cells, about {:.0f} s with {} jobs by the {}; at most {:.0f} s\n", count,
               total_s / options.jobs, options.jobs, basis, most_s / options.jobs);
  }
}

// The command that goes on with this run, to be pasted into a shell.
std::string resuming(const RunArguments& arguments, const std::filesystem::path& out) {
  // The folder's own says it all.
  const std::string grid = arguments.changes_grid() ? (out / "grid.toml").string() : arguments.grid;
  std::vector<std::string> words = {"tribench", "run", grid, "--out", out.string()};
  const auto add = [&words](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (!arguments.data.empty()) add("--data", arguments.data);
  if (arguments.shard != "1/1") add("--shard", arguments.shard);
  if (arguments.jobs > 0) add("--jobs", std::to_string(arguments.jobs));
  // A folder's own grid has it.
  if (!arguments.quarantine.empty() && !arguments.changes_grid()) {
    add("--quarantine", arguments.quarantine);
  }
  if (arguments.timing) words.emplace_back("--timing");
  words.emplace_back("--resume");
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

void print_end(const RunArguments& arguments, const RunTally& tally,
               const std::filesystem::path& out, const std::string& board) {
  if (!board.empty()) fmt::print("{}\n", board);
  for (const std::string& damage : tally.journal_damage) {
    print_message(fmt::format("tribench: cells.jsonl: {}\n", damage));
  }
  if (tally.stopped) {
    print_message(fmt::format("stopped: {} of {} cells are done; go on by: {}\n", tally.done(),
                              tally.cells, resuming(arguments, out)));
  } else {
    fmt::print("{} cells, {} failed, {:.1f} s; see {}\n", tally.done(), tally.failed, tally.wall_s,
               (out / "leaderboard.md").string());
  }
}

void run_to_the_end(const Grid& grid, const RunArguments& arguments, const RunOptions& options,
                    ExitStatus& status) {
  // The first signal lets the run close its files.
  const WholeRun run = run_whole(grid, options, stop_requested_by_signal());
  print_end(arguments, run.tally, options.out, run.board);
  if (!run.tally.stopped) write_run_pictures(options.out, arguments.pictures);
  if (run.all_failed()) {
    print_message(fmt::format("every cell failed, the first one by: {}\n",
                              reason_text(run.journal.results.front().record.reason)));
  }
  if (run.tally.stopped || run.all_failed()) status = ExitStatus::failed;
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
  if (!arguments.like.empty()) options.costs = measured_costs(read_run_folder(arguments.like));
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
  if (journal.identity.programs != program_files(grid)) {
    fmt::print("made with other files of its programs than these\n");
  }
  for (const std::string& difference : verdict.different) fmt::print("{}\n", difference);
  fmt::print("{} cells run again, {} differ; {} cells of the run promise nothing (clock, limits)\n",
             verdict.compared, verdict.different.size(), verdict.not_reproducible);
  if (!verdict.different.empty()) status = ExitStatus::found;
}

// The file may list cells of several grids: one that is not here is no error, but is said.
void add_quarantine_file(const std::string& file, Grid& grid) {
  const std::vector<std::string> globs = read_quarantine_file(file);
  Grid listed = grid;
  listed.quarantine = globs;
  const std::vector<std::string> idle = listed.idle_quarantine();
  if (!idle.empty()) {
    print_message(
        fmt::format("tribench: {}: {} of {} lines leave out no cell of this grid; the "
                    "first is '{}'; --dry-run lists the cells\n",
                    file, idle.size(), globs.size(), idle.front()));
  }
  grid.quarantine.insert(grid.quarantine.end(), globs.begin(), globs.end());
}

void run(const RunArguments& arguments, const Registry& registry, ExitStatus& status) {
  if (!arguments.verify.empty()) {
    verify(arguments, registry, status);
    return;
  }
  RunOptions options = options_of(arguments);
  Grid grid = arguments.own->files.empty()
                  ? load_named_grid(arguments.grid, registry, full_catalogue_of(options.data))
                  : make_data_grid(*arguments.own, registry);
  if (arguments.seeds) grid.seed_count = *arguments.seeds;
  if (arguments.evaluations) grid.limits.evaluations = *arguments.evaluations;
  if (arguments.seconds) {
    set_seconds(grid.limits, *arguments.seconds);
    if (!arguments.evaluations) spend_seconds_alone(grid.limits);
  }
  grid.require_runnable(arguments.seeds ? "--seeds" : grid.name);
  for (const std::string& note : reading_notes(grid))
    print_message(fmt::format("tribench: {}\n", note));
  if (!arguments.quarantine.empty()) add_quarantine_file(arguments.quarantine, grid);
  if (arguments.dry_run) {
    print_dry_run(grid, arguments, options);
    if (arguments.out.empty()) return;
    make_output_folder(arguments.out);
    write_plan_files(arguments.out, grid);
    return;
  }
  options.out = arguments.out.empty() ? fmt::format("run-{}", grid.name) : arguments.out;
  if (!arguments.pictures.empty()) make_picture_folder(arguments.pictures);  // before the work
  run_to_the_end(grid, arguments, options, status);
}

}  // namespace

void add_run_command(CLI::App& app, ExitStatus& status, const Registry& registry) {
  CLI::App* command = app.add_subcommand("run", "Runs a grid of cells and renders a leaderboard");
  command->footer(
      "Example: tribench run grids/paper.toml --out run-paper --jobs 8\n"
      "         tribench run --data-file logs --target tau --inputs v,load --methods '*'\n"
      "Without a file the built-in grid 'quick' runs. Ctrl-C leaves a run that --resume goes on "
      "with.");
  auto arguments = std::make_shared<RunArguments>();
  CLI::Option* grid =
      command
          ->add_option("grid", arguments->grid, "a grid file, or a name of `tribench list grids`")
          ->capture_default_str();
  grid->excludes(add_data_grid_options(*command, arguments->own));
  constexpr double kMostSeconds = 2e6;
  command->add_option("--seeds", arguments->seeds, "how many, in place of the grid's")
      ->transform(whole_number(1, 1'000'000));
  command->add_option("--evaluations", arguments->evaluations, "budget of a cell in node-rows")
      ->transform(whole_number(0));
  command->add_option("--seconds", arguments->seconds, "budget of a cell in CPU seconds")
      ->transform(real_number(0, kMostSeconds));
  command->add_option("--out", arguments->out, "the run's folder (default: run-NAME)");
  command->add_option("--jobs", arguments->jobs, "worker processes at a time (default: all cores)")
      ->transform(whole_number(1, 4096));
  command->add_option("--shard", arguments->shard, "K/N: the K-th of N parts of the grid");
  command->add_option("--data", arguments->data, "folder of the measured sets");
  command->add_flag("--resume", arguments->resume, "run what the folder does not have yet");
  command->add_flag("--dry-run", arguments->dry_run,
                    "only list the cells and what they cost: at most, or by --like");
  command->add_option("--like", arguments->like,
                      "a finished run whose seconds a method foretell this one's");
  command->add_flag("--timing", arguments->timing,
                    "for times to compare: one core is left free, workers are pinned");
  command->add_option("--quarantine", arguments->quarantine,
                      "a file of cells (globs, one a line) that are not run");
  command->add_option("--verify", arguments->verify,
                      "run some cells of this finished run again and compare them bit for bit");
  command->add_option("--sample", arguments->sample, "with --verify: how many cells")
      ->transform(whole_number(1))
      ->capture_default_str();
  add_pictures_option(*command, arguments->pictures);
  command->add_flag("--quiet", arguments->quiet, "no progress line");
  command->add_flag("--json", arguments->json, "with --dry-run: as JSON");
  command->callback([arguments, &registry, &status] { run(*arguments, registry, status); });
}

}  // namespace tribench
