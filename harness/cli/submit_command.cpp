// SPDX-License-Identifier: MIT
//
// tribench submit: a grid as a job array on a cluster.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "foundation/error.hpp"
#include "foundation/standard_streams.hpp"
#include "harness/catalogue.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/shipped_grids.hpp"
#include "harness/slurm.hpp"
#include "problems/measured/data_folder.hpp"
#include "reports/run_reports.hpp"

namespace tribench {
namespace {

struct SubmitArguments {
  std::string grid;
  std::string out;
  std::string data;
  std::string partition;
  std::size_t shards = 0;
  std::size_t largest_array = 1000;
  int jobs = 1;
  bool slurm = false;
  bool detach = false;
  bool dry_run = false;
};

void submit(const SubmitArguments& arguments, const Registry& registry, ExitStatus& status) {
  SlurmOptions options;
  options.out = std::filesystem::absolute(arguments.out);
  options.program = std::filesystem::read_symlink("/proc/self/exe");
  const auto data = measured::find_data_folder(
      arguments.data.empty() ? std::nullopt : std::optional<std::filesystem::path>(arguments.data));
  if (data) options.data = std::filesystem::absolute(*data).string();
  options.shards = arguments.shards;
  options.jobs = arguments.jobs;
  options.partition = arguments.partition;
  options.largest_array = arguments.largest_array;
  const Grid grid = load_named_grid(arguments.grid, registry, full_catalogue(data));
  const SlurmPlan plan = plan_slurm(grid, options);
  fmt::print("{} cells in {} elements of about {:.0f} s each\n", grid.cell_count(), plan.shards,
             plan.predicted_element_s);
  if (arguments.dry_run) {
    fmt::print("{}\n{}", plan.array_script, plan.merge_script);
    return;
  }
  const SlurmJobs jobs = submit_slurm(grid, plan, options);
  fmt::print("array {}, merge {}; logs in {}\n", jobs.array, jobs.merge,
             (options.out / "log").string());
  if (arguments.detach) return;
  if (!follow_slurm(jobs, stop_requested_by_signal())) {
    print_message("no longer following; the jobs go on\n");
    status = ExitStatus::undecided;
    return;
  }
  if (!std::filesystem::exists(options.out / "results.csv")) {
    throw Error(ErrorKind::failed, "the merge left no results", (options.out / "log").string(),
                "read the logs there, then submit again: what is done is kept");
  }
  fmt::print("{}\n", write_run_reports(options.out));
}

}  // namespace

void add_submit_command(CLI::App& app, ExitStatus& status, const Registry& registry) {
  CLI::App* command =
      app.add_subcommand("submit", "Runs a grid as a job array on a cluster, and merges it");
  command->footer(
      "Example: tribench submit grids/paper.toml --slurm --out run-paper\n"
      "Submitting to the same folder again runs only what is missing.");
  auto arguments = std::make_shared<SubmitArguments>();
  command->add_option("grid", arguments->grid, "a grid file, or the name of a shipped grid")
      ->required();
  command->add_flag("--slurm", arguments->slurm, "by Slurm (the one that is known)")->required();
  command->add_option("--out", arguments->out, "the run's folder, seen by every node")->required();
  command
      ->add_option("--shards", arguments->shards,
                   "elements of the array (default: of about five minutes each)")
      ->transform(whole_number(1, 10'000'000));
  command->add_option("--jobs", arguments->jobs, "worker processes an element")
      ->transform(whole_number(1, 1024))
      ->capture_default_str();
  command->add_option("--partition", arguments->partition, "the cluster's partition");
  command->add_option("--largest-array", arguments->largest_array, "what the site allows")
      ->transform(whole_number(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--data", arguments->data, "folder of the measured sets");
  command->add_flag("--detach", arguments->detach, "submit and leave");
  command->add_flag("--dry-run", arguments->dry_run, "only show the scripts");
  command->callback([arguments, &registry, &status] { submit(*arguments, registry, status); });
}

}  // namespace tribench
