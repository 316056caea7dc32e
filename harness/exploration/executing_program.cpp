// SPDX-License-Identifier: MIT
#include "harness/exploration/executing_program.hpp"

#include <fmt/format.h>

#include <utility>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "foundation/scratch_folder.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

constexpr std::size_t kMostOutputBytes = 1U << 26;  // a program that prints without end is stopped
constexpr std::size_t kMostReason = 400;            // characters of what it said
constexpr int kRefused = 2;

std::string end_of_text(const std::string& text) {
  return text.substr(text.size() - std::min(text.size(), kMostReason));
}

}  // namespace

loop::ExecuteMovement executing_program(std::vector<std::string> command, double limit_s) {
  return [command = std::move(command), limit_s](const PlannedMovement& movement) {
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch.path() / "movements.csv";
    write_file(file, movements_text({movement}, "rad", "rad/s"));
    ChildOptions options;
    options.command = command;
    options.command.push_back(file.string());
    options.scratch = scratch.path();
    const ChildRun run = run_child(options, {}, {limit_s, kMostOutputBytes});
    if (run.timed_out) {
      throw Error(ErrorKind::failed, fmt::format("the program took longer than {} s", limit_s),
                  command.front());
    }
    if (run.exit.signal == 0 && run.exit.status == kRefused) {
      throw_bad_input(fmt::format("refused: {}", end_of_text(run.errors)), command.front());
    }
    if (!run.exit.ok()) {
      const std::string how = run.exit.signal != 0 ? signal_name(run.exit.signal)
                                                   : fmt::format("status {}", run.exit.status);
      throw Error(ErrorKind::failed,
                  fmt::format("the program ended with {}: {}", how, end_of_text(run.errors)),
                  command.front(), "exit status 2 refuses a movement");
    }
    try {
      return parse_csv(run.output, "the program's answer").data;
    } catch (const Error& error) {
      throw Error(ErrorKind::failed, error.what(), command.front(),
                  "print the recording as CSV, with names as in docs/explore.md");
    }
  };
}

}  // namespace tribench
