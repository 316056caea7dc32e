// SPDX-License-Identifier: MIT
#include "harness/slurm.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/shell_word.hpp"
#include "foundation/standard_streams.hpp"
#include "foundation/text.hpp"
#include "harness/run_files.hpp"

namespace tribench {
namespace {

constexpr double kElementSeconds = 300;  // half a second an element is Slurm's own: well below 1 %
constexpr int kProgramMemoryMib = 256;   // the run itself, beside its workers

// A value in a line of the script's header. sbatch reads quotes there; a line's end would begin a
// line of its own.
std::string header_value(const std::string& value, const char* option) {
  if (holds_control_characters(value) || value.find_first_of("\"\\") != std::string::npos) {
    throw_bad_input(fmt::format("'{}' cannot stand in a Slurm script", value), option,
                    "use no quotes, backslashes or control characters");
  }
  // A single quote would open one, and a hash begins a comment.
  const bool is_plain = value.find_first_of(" '#") == std::string::npos;
  return is_plain ? value : fmt::format("\"{}\"", value);
}

// A path in which Slurm takes no %j for the job's number.
std::string without_patterns(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text;
}

std::string header(const std::string& name, const SlurmOptions& options, int minutes,
                   int memory_mib, int processors, const std::string& log) {
  std::string text = fmt::format(
      "#!/bin/bash\n#SBATCH --job-name=tribench-{}\n#SBATCH --output={}\n"
      "#SBATCH --open-mode=append\n#SBATCH --time={}\n#SBATCH --mem={}M\n"
      "#SBATCH --cpus-per-task={}\n#SBATCH --requeue\n",
      name, header_value(log, "--out"), minutes, memory_mib, processors);
  if (!options.partition.empty())
    text += fmt::format("#SBATCH --partition={}\n", header_value(options.partition, "--partition"));
  return text + "set -eu\n";
}

std::string submit(const std::vector<std::string>& command) {
  ChildRun result;
  try {
    result = run_child({.command = command});
  } catch (const Error&) {
    throw_bad_input("sbatch is not installed here", "--slurm",
                    "submit from a machine of the cluster, or run shards by --shard K/N");
  }
  if (!result.exit.ok()) {
    throw Error(ErrorKind::failed, fmt::format("sbatch refused the job: {}", result.errors));
  }
  // --parsable prints "id" or "id;cluster".
  const std::string job = result.output.substr(0, result.output.find_first_of(";\n"));
  if (!read_number<std::uint64_t>(job)) {
    throw Error(ErrorKind::failed,
                fmt::format("sbatch answers '{}', which is no job's number", job), "sbatch",
                "look for the job by squeue; is this the sbatch of Slurm?");
  }
  return job;
}

// Of these jobs; none where Slurm does not answer, and `errors` says why: a controller that is busy
// or started again has lost nothing.
std::optional<std::size_t> elements_left(std::initializer_list<std::string> jobs,
                                         std::string& errors) {
  std::size_t left = 0;
  for (const std::string& job : jobs) {
    const ChildRun result = run_child({.command = {"squeue", "-h", "-r", "-o", "%i", "-j", job}});
    const bool is_forgotten = result.errors.find("Invalid job id") != std::string::npos;
    if (!result.exit.ok() && !is_forgotten) {
      errors = trimmed(result.errors);
      return {};
    }
    left += static_cast<std::size_t>(std::ranges::count(result.output, '\n'));
  }
  return left;
}

}  // namespace

SlurmPlan plan_slurm(const Grid& grid, const SlurmOptions& options, const MeasuredCosts& costs) {
  const std::vector<PlannedWork> work = plan_work(grid, {}, costs);
  double total_s = 0;
  for (const PlannedWork& item : work) total_s += item.predicted_s;
  SlurmPlan plan;
  const double wanted = std::ceil(total_s / options.jobs / kElementSeconds);
  plan.shards = options.shards > 0 ? options.shards : static_cast<std::size_t>(wanted);
  plan.shards =
      std::clamp<std::size_t>(plan.shards, 1, std::min(options.largest_array, work.size()));
  double longest_s = 0;
  for (const PlannedWork& item : plan_work(grid, {1, plan.shards}, costs)) {
    longest_s += item.predicted_s;
  }
  plan.predicted_element_s = longest_s / options.jobs;
  double wall_s = 0;
  double memory_mib = 0;
  for (const Method& method : grid.methods) {
    wall_s = std::max(wall_s, grid.limits_of(method).wall_seconds);
    memory_mib = std::max(memory_mib, grid.limits_of(method).memory_mib);
  }
  // Predictions err: four times, and one cell at its limit. What does not fit is missing after the
  // merge, and a second submission runs it.
  plan.minutes = 5 + static_cast<int>(std::ceil((4 * plan.predicted_element_s + wall_s) / 60));
  plan.memory_mib = kProgramMemoryMib + options.jobs * static_cast<int>(std::ceil(memory_mib));
  const std::string folder = options.out.string();
  const std::string logs = without_patterns(folder) + "/log";
  const std::string name = grid.name;
  const std::string data = options.data.empty() ? "" : " --data " + shell_word(options.data);
  plan.array_script =
      header(name, options, plan.minutes, plan.memory_mib, options.jobs, logs + "/element-%a.log") +
      fmt::format(
          "exec {0} run {1} --out {2}/shard-$SLURM_ARRAY_TASK_ID "
          "--shard $SLURM_ARRAY_TASK_ID/{3} --jobs {4} --resume --quiet{5}\n",
          shell_word(options.program.string()), shell_word(folder + "/grid.toml"),
          shell_word(folder), plan.shards, options.jobs, data);
  plan.merge_script = header(name + "-merge", options, 60, 2048, 1, logs + "/merge.log") +
                      fmt::format("rm -f {0}/cells.jsonl\nexec {1} merge {0}/shard-* --out {0}\n",
                                  shell_word(folder), shell_word(options.program.string()));
  return plan;
}

SlurmJobs submit_slurm(const Grid& grid, const SlurmPlan& plan, const SlurmOptions& options) {
  make_output_folder(options.out / "log");
  write_plan_files(options.out, grid);
  write_file(options.out / "array.sh", plan.array_script);
  write_file(options.out / "merge.sh", plan.merge_script);
  SlurmJobs jobs;
  jobs.array = submit({"sbatch", "--parsable", fmt::format("--array=1-{}", plan.shards),
                       (options.out / "array.sh").string()});
  // After any end of the elements: what failed shows as missing in the merged leaderboard.
  jobs.merge = submit({"sbatch", "--parsable", "--dependency=afterany:" + jobs.array,
                       (options.out / "merge.sh").string()});
  return jobs;
}

bool follow_slurm(const SlurmJobs& jobs, const std::atomic<bool>& stop) {
  const bool is_terminal = ::isatty(STDERR_FILENO) == 1;
  std::string shown;
  while (!stop.load()) {
    std::string errors;
    const std::optional<std::size_t> left = elements_left({jobs.array, jobs.merge}, errors);
    if (left == std::size_t{0}) return true;
    const std::string state = left ? fmt::format("{} elements left", *left)
                                   : fmt::format("Slurm does not answer, asked again: {}", errors);
    if (is_terminal) {
      print_message(fmt::format("\r\033[K{}", state));
    } else if (state != shown) {
      print_message(state + '\n');
    }
    shown = state;
    for (int tenth = 0; tenth < 20 && !stop.load(); ++tenth) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  return false;
}

}  // namespace tribench
