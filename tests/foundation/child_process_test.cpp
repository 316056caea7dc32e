// SPDX-License-Identifier: MIT
#include "foundation/child_process.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "foundation/error.hpp"

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

}  // namespace
}  // namespace tribench
