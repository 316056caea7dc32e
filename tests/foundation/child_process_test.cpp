// SPDX-License-Identifier: MIT
#include "foundation/child_process.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <exception>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>

#include "foundation/error.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

ChildRun shell(const std::string& line, std::string_view input = {}) {
  return run_child({.command = {"sh", "-c", line}}, input);
}

TEST(RunChild, KeepsOutputErrorsAndExitStatusApart) {
  const ChildRun run = shell("echo out; echo wrong >&2; exit 3");
  EXPECT_EQ(run.output, "out\n");
  EXPECT_EQ(run.errors, "wrong\n");
  EXPECT_EQ(run.exit.status, 3);
  EXPECT_FALSE(run.exit.ok());
  EXPECT_TRUE(shell("true").exit.ok());
}

TEST(RunChild, HandsInputOverAndClosesIt) {
  EXPECT_EQ(shell("cat", "line\n").output, "line\n");
  EXPECT_EQ(shell("cat").output, "");
}

TEST(RunChild, KeepsMoreOutputThanAPipeHolds) {
  EXPECT_EQ(shell("head -c 1000000 /dev/zero").output.size(), 1000000U);
}

TEST(RunChild, SurvivesAProgramThatDoesNotReadItsInput) {
  EXPECT_EQ(shell("exec 0<&-; exit 4", std::string(1U << 20, 'x')).exit.status, 4);
}

TEST(RunChild, NamesTheSignalThatEndedIt) {
  const ChildRun run = shell("kill -TERM $$");
  EXPECT_EQ(run.exit.signal, SIGTERM);
  EXPECT_FALSE(run.exit.ok());
  EXPECT_EQ(signal_name(run.exit.signal), "SIGTERM");
}

TEST(RunChild, TellsHowItEndedAndWhatItSaidLast) {
  const auto told = [](const std::string& line) {
    const ChildRun run = shell(line);
    return told_of_end(run.exit, run.errors);
  };
  EXPECT_EQ(told("exit 3"), "status 3, with nothing on its standard error");
  EXPECT_EQ(told("echo wrong >&2; kill -KILL $$"), "SIGKILL: wrong");
  // Of 501 bytes the last 400 would begin within a character.
  EXPECT_TRUE(told("for i in $(seq 250); do printf é >&2; done; printf x >&2; exit 1")
                  .starts_with("status 1: é"));
}

TEST(RunChild, SetsEnvironmentAndFolder) {
  const ChildRun run = run_child({.command = {"sh", "-c", "echo $TRIBENCH_TOLD; pwd"},
                                  .environment = {"TRIBENCH_TOLD=so"},
                                  .working_directory = "/"});
  EXPECT_EQ(run.output, "so\n/\n");
}

TEST(RunChild, RefusesAProgramThatIsNotThere) {
  EXPECT_THROW(run_child({.command = {"no-program-of-this-name"}}), Error);
  EXPECT_THROW(run_child({}), Error);
}

// Programs that try to leave something behind.
class EscapingChild : public ::testing::Test {
 protected:
  // Runs a line of shell in which `note` writes down the pid of what it runs in the background.
  std::string line(const std::string& rest) const {
    return "note() { setsid -f bash -c 'echo $$ >> " + (folder_ / "pids").string() +
           "; sleep 987'; }; note; (note &); while [ $(wc -l < " + (folder_ / "pids").string() +
           ") -lt 2 ]; do sleep 0.01; done; " + rest;
  }
  void expect_all_ended() const {
    std::istringstream pids(testing::read_text(folder_ / "pids"));
    int count = 0;
    for (int pid = 0; pids >> pid; ++count) EXPECT_FALSE(testing::is_running(pid)) << pid;
    EXPECT_EQ(count, 2);
  }
  testing::TemporaryFolder folder_;
};

TEST_F(EscapingChild, IsEndedWithItsProgramThoughItHoldsTheOutput) {
  testing::write_text(folder_ / "pids", "");
  const ChildRun run =
      run_child({.command = {"bash", "-c", line("echo front; exit 0")}}, {}, {.wall_s = 20});
  EXPECT_FALSE(run.timed_out);
  EXPECT_TRUE(run.exit.ok());
  EXPECT_EQ(run.output, "front\n");
  expect_all_ended();
}

TEST_F(EscapingChild, IsEndedWhenTimeIsUp) {
  testing::write_text(folder_ / "pids", "");
  const ChildRun run = run_child({.command = {"bash", "-c", line("sleep 987")}}, {}, {.wall_s = 1});
  EXPECT_TRUE(run.timed_out);
  EXPECT_EQ(run.exit.signal, SIGKILL);
  expect_all_ended();
}

TEST_F(EscapingChild, TakesItsScratchFolderWithIt) {
  testing::write_text(folder_ / "pids", "");
  const std::filesystem::path scratch = folder_ / "scratch";
  testing::write_text(scratch / "inner" / "file", "text");
  run_child({.command = {"bash", "-c", line("exit 3")}, .scratch = scratch});
  EXPECT_FALSE(std::filesystem::exists(scratch));
  expect_all_ended();
}

TEST_F(EscapingChild, IsEndedThoughTheProgramKillsItsParent) {
  testing::write_text(folder_ / "pids", "");
  const std::filesystem::path scratch = folder_ / "scratch";
  testing::write_text(scratch / "file", "text");
  const ChildRun run =
      run_child({.command = {"bash", "-c", line("kill -9 $PPID; sleep 987")}, .scratch = scratch},
                {}, {.wall_s = 20});
  EXPECT_FALSE(run.timed_out);
  EXPECT_EQ(run.exit.signal, SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(scratch));
  expect_all_ended();
}

// Nothing more can come from it, but it has not ended.
TEST(RunChild, EndsAProgramThatClosedItsStreamsWhenTimeIsUp) {
  const ChildRun run =
      run_child({.command = {"bash", "-c", "exec >&- 2>&-; sleep 60"}}, {}, {.wall_s = 0.5});
  EXPECT_TRUE(run.timed_out);
}

TEST(RunChild, HandsOverMoreThanAPipeHoldsToWhoeverReadsOrDoesNot) {
  const std::string much(1U << 22, 'x');
  const ChildRun all = run_child({.command = {"sh", "-c", "head -c 1000000 /dev/zero; cat"}}, much);
  EXPECT_EQ(all.output.size(), 1'000'000 + much.size());
  const ChildRun none = run_child({.command = {"sleep", "60"}}, much, {.wall_s = 0.5});
  EXPECT_TRUE(none.timed_out);
  const ChildRun some = run_child({.command = {"head", "-c", "3"}}, much);
  EXPECT_EQ(some.output, "xxx");
  EXPECT_EQ(some.exit.status, 0);
}

TEST(RunChild, StopsAProgramThatPrintsWithoutEnd) {
  EXPECT_THROW(run_child({.command = {"yes"}}, {}, {.output_bytes = 1U << 20}), Error);
}

TEST(ProcessTreeUse, CountsWhatHasLeftItsParent) {
  ChildProcess child({.command = {"bash", "-c", "(setsid bash -c 'while :; do :; done' &); read"}});
  double cpu_s = 0;
  for (int i = 0; i < 1000 && cpu_s < 0.05; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    cpu_s = process_tree_use(::getpid()).cpu_s - process_tree_use(0).cpu_s;
  }
  EXPECT_GE(cpu_s, 0.05);
}

TEST(RunChild, WhereNoFileMayBeOpenedTheLimitIsNamed) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{3, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  std::exception_ptr refused;
  try {
    shell("true");
  } catch (...) {
    refused = std::current_exception();
  }
  ::setrlimit(RLIMIT_NOFILE, &before);  // a sanitizer opens files of its own to look at an object
  ASSERT_TRUE(refused);
  try {
    std::rethrow_exception(refused);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::environment);
    EXPECT_EQ(error.mend(), "allow more open files (ulimit -n)");
  }
}

}  // namespace
}  // namespace tribench
