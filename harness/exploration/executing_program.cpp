// SPDX-License-Identifier: MIT
#include "harness/exploration/executing_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/text.hpp"
#include "harness/exploration/recorded_motion.hpp"
#include "problems/campaign_channels.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

constexpr std::size_t kMostOutputBytes = 1U << 26;  // a program that prints without end is stopped
constexpr std::size_t kMostReason = 400;            // characters of what it said
constexpr int kRefused = 2;

std::string end_of_text(const std::string& text) {
  const std::string_view said = trimmed(text);
  return std::string(said.substr(said.size() - std::min(said.size(), kMostReason)));
}

class Program {
 public:
  Program(std::vector<std::string> command, const MotionLimits& limits, double limit_s,
          const std::atomic<bool>* end)
      : command_(std::move(command)), limits_(limits), limit_s_(limit_s), end_(end) {}

  // A program need not know the limits: it is not asked for what breaks one.
  Dataset execute(const PlannedMovement& movement) const {
    if (const BrokenLimit limit = broken_limit(movement, limits_); limit.broken()) {
      throw_bad_input(limit.what, "the limits", limit.mend);
    }
    const std::string output = run(movement);
    CsvOptions options;
    options.drop_missing = true;  // a cell without a value costs its row, not the exploration
    DataFile file;
    try {
      file = parse_csv(output, "the program's answer", options);
    } catch (const Error& error) {
      fail(error.what(), "print the recording as CSV, with names as in docs/explore.md");
    }
    if (file.data.rows() == 0)
      fail("the recording has no rows", "exit status 2 refuses a movement");
    check_channels(file.data);
    name_as_read(file.data);
    if (const Misfit misfit = misfit_of(file.data, movement, limits_); misfit.is_one()) {
      fail(misfit.what, misfit.mend);
    }
    return std::move(file.data);
  }

 private:
  [[noreturn]] void fail(std::string_view what, std::string_view mend) const {
    throw Error(ErrorKind::failed, what, command_.front(), mend);
  }

  std::string run(const PlannedMovement& movement) const {
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch.path() / "movements.csv";
    write_file(file, movements_text({movement}, "rad", "rad/s"));
    ChildOptions options;
    options.command = command_;
    options.command.push_back(file.string());
    options.scratch = scratch.path();
    options.environment.push_back("TMPDIR=" + scratch.path().string());
    const ChildRun run = run_child(options, {}, {limit_s_, kMostOutputBytes, end_});
    if (run.broken_off) fail("the movement was broken off, since an end was asked for", {});
    if (run.timed_out) {
      fail(fmt::format("the program took longer than {} s", limit_s_),
           "--command-seconds gives it more");
    }
    if (run.exit.signal == 0 && run.exit.status == kRefused) {
      throw_bad_input(fmt::format("refused: {}", end_of_text(run.errors)), command_.front());
    }
    if (!run.exit.ok()) {
      fail(fmt::format("the program ended with {}", told_of_end(run.exit, run.errors)),
           "exit status 2 refuses a movement");
    }
    return run.output;
  }

  // The explorer knows beforehand what each movement will look like, in these quantities alone.
  void check_channels(const Dataset& data) const {
    for (const Role role : {Role::time, Role::position, Role::velocity}) {
      if (data.find(role) != nullptr) continue;
      fail(fmt::format("the recording has no {}", role_name(role)),
           "every recording needs time, position, velocity and a torque (docs/explore.md)");
    }
    if (data.find(Role::friction_torque) != nullptr) return;
    const Channel* torque = data.find(Role::motor_torque);
    if (torque == nullptr || torque->unit != "N m") {
      fail("the recording has neither friction_torque_Nm nor motor_torque_Nm",
           "print the friction torque, or the motor torque with gravity_torque_Nm beside it; a "
           "current is turned into a torque by its constant");
    }
    if (limits_.gravity_nm == 0 || data.find(Role::gravity_torque) != nullptr) return;
    fail("the motor torque holds gravity, and no gravity_torque_Nm is beside it",
         "print it too, or the friction torque; without gravity, gravity_Nm is 0 in the limits");
  }

  // What was read is in SI units: its channels get the names that say so.
  static void name_as_read(Dataset& data) {
    for (Channel& channel : data.channels) {
      if (channel.role != Role::none) channel.name = channel_name(channel.role, channel.unit);
    }
  }

  std::vector<std::string> command_;
  MotionLimits limits_;
  double limit_s_;
  const std::atomic<bool>* end_;
};

// Runs on from `ended_s`, which becomes the end of these rows.
void run_clock_on(Dataset& data, double rest_s, double& ended_s) {
  const auto clock = std::ranges::find(data.channels, Role::time, &Channel::role);
  if (clock->values.front() <= ended_s) {
    const double step_s =
        (clock->values.back() - clock->values.front()) / static_cast<double>(clock->values.size());
    const double behind = ended_s + rest_s + step_s - clock->values.front();
    for (double& t : clock->values) t += behind;
  }
  ended_s = clock->values.back();
}

}  // namespace

loop::ExecuteMovement executing_program(std::vector<std::string> command,
                                        const MotionLimits& limits, double limit_s,
                                        const std::atomic<bool>* end) {
  return [program = Program(std::move(command), limits, limit_s, end)](
             const PlannedMovement& movement) { return program.execute(movement); };
}

loop::ExecuteMovement with_running_clock(loop::ExecuteMovement execute) {
  return [execute = std::move(execute), ended_s = -std::numeric_limits<double>::infinity()](
             const PlannedMovement& movement) mutable {
    Dataset rows = execute(movement);
    run_clock_on(rows, movement.rest, ended_s);
    return rows;
  };
}

}  // namespace tribench
