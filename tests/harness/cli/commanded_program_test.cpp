// SPDX-License-Identifier: MIT
//
// A program of somebody else's that a command runs, however the command ends: nothing that the
// program started outlives it, no folder of either stays, and where there is no room it is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Every one of its processes leaves its number; none ends when asked to.
constexpr std::string_view kProgram =
    "trap '' TERM INT HUP\n"
    "echo $$ >> \"$(dirname \"$0\")/pids\"\n"
    "touch \"${TMPDIR:-/tmp}/tribench-of-the-program\"\n"
    "setsid -f sh \"$(dirname \"$0\")/child.sh\"\n"
    "(setsid -f sh \"$(dirname \"$0\")/child.sh\")\n"
    "sleep 987\nsleep 987\n";
constexpr std::string_view kChild =
    "trap '' TERM INT HUP\necho $$ >> \"$(dirname \"$0\")/pids\"\nsleep 987\nsleep 987\n";
constexpr int kProcesses = 3;

class CommandedProgram : public ::testing::TestWithParam<const char*> {
 protected:
  CommandedProgram() {
    write_text(folder_ / "program.sh", kProgram);
    write_text(folder_ / "child.sh", kChild);
    std::filesystem::create_directory(folder_ / "temporary");
    run_tribench({"world", "7", "--out", (folder_ / "w").string()});
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  // The command, as a shell takes it, whose program runs this script.
  std::string line(const std::string& script) const {
    std::string words = GetParam();
    const std::size_t limits = words.find("LIMITS");
    if (limits != std::string::npos) words.replace(limits, 6, path("w/world.json"));
    return "'" + program().string() + "' " + words + " --out " + path("out") + " --command sh " +
           path(script);
  }
  // Started by a shell that has gone. Returns its number once the program and its children run.
  int start() const {
    const std::string whole = "TMPDIR=" + path("temporary") + " " + line("program.sh") +
                              " > /dev/null 2>&1 & echo $! > " + path("command");
    EXPECT_EQ(std::system(whole.c_str()), 0);
    until([&] {
      const std::string pids = std::filesystem::exists(path("pids")) ? read_text(path("pids")) : "";
      return std::ranges::count(pids, '\n') >= kProcesses;
    });
    return std::stoi(read_text(path("command")));
  }
  template <typename Condition>
  static bool until(Condition is_so) {
    for (int i = 0; i < 1000; ++i) {
      if (is_so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  void expect_nothing_left(int command) const {
    EXPECT_TRUE(until([&] { return !is_running(command); })) << "the command";
    std::istringstream started(read_text(path("pids")));
    int count = 0;
    for (int pid = 0; started >> pid; ++count) {
      EXPECT_TRUE(until([&] { return !is_running(pid); })) << pid;
    }
    EXPECT_GE(count, kProcesses);
    until([&] { return std::filesystem::is_empty(path("temporary")); });
    std::vector<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator(path("temporary"))) {
      left.push_back(entry.path().filename());
    }
    EXPECT_THAT(left, IsEmpty());
  }

  TemporaryFolder folder_;
};

TEST_P(CommandedProgram, IsEndedWithACommandThatIsKilled) {
  const int command = start();
  ::kill(command, SIGKILL);
  expect_nothing_left(command);
}

// A first signal may let the program come to its end; the second one does not. (SIGINT is ignored
// in what a shell starts beside itself.)
TEST_P(CommandedProgram, IsEndedWithACommandThatIsAskedTwice) {
  const int command = start();
  ::kill(command, SIGHUP);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  ::kill(command, SIGHUP);
  expect_nothing_left(command);
}

// Whoever sends SIGTERM sends SIGKILL next, half a minute or so later.
TEST_P(CommandedProgram, IsEndedWithACommandThatTheMachineEnds) {
  const int command = start();
  ::kill(command, SIGTERM);
  expect_nothing_left(command);
}

TEST_P(CommandedProgram, IsNotRunWhereThereIsNoFolderForIt) {
  const ProgramRun run = run_to_end({"sh", "-c", "TMPDIR=/no/such/folder " + line("program.sh")});
  EXPECT_EQ(run.status, 3) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("TMPDIR"));
  EXPECT_FALSE(std::filesystem::exists(path("pids")));
}

// A challenge of three worlds that gets the signal in its second: the first one's program says its
// verdict, the second's waits.
ProgramRun signalled_in_the_second_world(const TemporaryFolder& folder, const char* signal) {
  write_text(folder / "slow.sh",
             "read hello\nif [ -e first ]; then touch second; sleep 60; fi\n"
             "touch first\necho '{\"verdict\": null}'\n");
  write_text(folder / "signal.sh", "cd \"$1\"\n'" + program().string() +
                                       "' challenge --worlds 3 --out board --command sh slow.sh &\n"
                                       "while [ ! -e second ]; do sleep 0.01; done\n"
                                       "kill -" +
                                       signal + " $!; wait $!\n");
  return run_to_end({"sh", (folder / "signal.sh").string(), folder.path().string()});
}

TEST(ChallengeCommand, WhatWasScoredBeforeItWasKilledIsOnDisk) {
  const TemporaryFolder folder;
  EXPECT_EQ(signalled_in_the_second_world(folder, "KILL").status, 137);
  const std::filesystem::path score = folder / "board/entry.json";
  ASSERT_TRUE(std::filesystem::exists(score));
  EXPECT_EQ(nlohmann::json::parse(read_text(score))["results"].size(), 1U);
}

TEST(ChallengeCommand, TheMachinesSignalDropsTheWorldUnderWayAlone) {
  const TemporaryFolder folder;
  const ProgramRun done = signalled_in_the_second_world(folder, "TERM");
  EXPECT_EQ(done.status, 3) << done.errors;
  EXPECT_THAT(done.errors, HasSubstr("stopped: 1 of 3 worlds are done"));
  EXPECT_THAT(read_text(folder / "board/leaderboard.md"), HasSubstr("entry (1 of 3)"));
}

INSTANTIATE_TEST_SUITE_P(Commands, CommandedProgram,
                         ::testing::Values("study loop --runs 3 --per-cell 1 --jobs 1",
                                           "challenge --worlds 2",
                                           "explore --limits LIMITS --budget 300s"));

}  // namespace
}  // namespace tribench::testing
