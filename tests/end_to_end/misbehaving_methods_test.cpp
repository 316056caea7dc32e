// SPDX-License-Identifier: MIT
//
// Methods that crash, hang and eat memory cost their own cells, with the reason, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class MisbehavingMethodsTest : public ::testing::Test {
 protected:
  // Reasons by method, for one problem and one seed.
  std::map<std::string, std::string> run(const std::string& grid, int expected_status = 0) {
    write_text(folder_ / "grid.toml", grid);
    const ProgramRun ended =
        run_to_end({test_program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                    (folder_ / "run").string(), "--jobs", "2"});
    EXPECT_EQ(ended.status, expected_status) << ended.errors;
    std::map<std::string, std::string> reasons;
    for (const auto& [cell, reason] : column_of(folder_ / "run", "reason")) {
      const std::size_t start = cell.find('|') + 1;
      reasons[cell.substr(start, cell.find('|', start) - start)] = reason;
    }
    return reasons;
  }

  TemporaryFolder folder_;
};

TEST_F(MisbehavingMethodsTest, EachCostsItsOwnCellAndSaysWhy) {
  // On a busy machine a second of processor time may take many.
  std::map<std::string, std::string> reasons = run(R"([grid]
problems = ["A/j2/no_load"]
methods = ["test_*", "!test_hang"]
operators = ["paper"]
[budget]
evaluations = 1_000_000
seconds = 5
wall_seconds = 120
cpu_limit_seconds = 1
memory_mib = 256
)");
  EXPECT_EQ(reasons["test_mean"], "");
  EXPECT_EQ(reasons["test_search"], "");
  EXPECT_EQ(reasons["test_crash"], "crashed (SIGSEGV)");
  EXPECT_EQ(reasons["test_abort"], "crashed (SIGABRT)");
  EXPECT_EQ(reasons["test_exit"], "crashed (exit status 7)");
  EXPECT_EQ(reasons["test_busy_hang"], "cpu_limit");
#ifdef TRIBENCH_SANITIZED  // whose shadow memory is too large to be limited
  EXPECT_EQ(reasons["test_eat_memory"], "cpu_limit");
#else
  EXPECT_EQ(reasons["test_eat_memory"], "out_of_memory");
#endif
  EXPECT_EQ(reasons["test_throw"], "error (a method's own words)");
  EXPECT_THAT(reasons["test_nothing"], StartsWith("error (no formula"));
  EXPECT_EQ(reasons["test_flaky"], "");
  EXPECT_EQ(reasons.size(), 14U);
  const auto datasets = column_of(folder_ / "run", "dataset");
  EXPECT_EQ(datasets.at("A/j2/no_load|test_crash|-|1"), "A") << "a crashed cell is named in full";
}

TEST_F(MisbehavingMethodsTest, OneThatSleepsIsEndedByTheClock) {
  const std::map<std::string, std::string> reasons = run(R"([grid]
problems = ["A/j2/no_load"]
methods = ["test_hang", "test_mean"]
[budget]
seconds = 2
wall_seconds = 5
)");
  EXPECT_EQ(reasons.at("test_hang"), "timeout");
  EXPECT_EQ(reasons.at("test_mean"), "");
}

TEST_F(MisbehavingMethodsTest, APoleBetweenTheDataIsRefutedWithAWitness) {
  run(R"([grid]
problems = ["A/j2/no_load"]
methods = ["test_pole"]
operators = ["paper+div"]
)");
  const std::string cell = "A/j2/no_load|test_pole|paper+div|1";
  EXPECT_EQ(column_of(folder_ / "run", "singularity").at(cell), "refuted");
  EXPECT_THAT(column_of(folder_ / "run", "witness").at(cell), HasSubstr("0.0123456789"));
  EXPECT_THAT(read_text(folder_ / "run" / "leaderboard.md"), HasSubstr("0.012345"));
}

TEST_F(MisbehavingMethodsTest, ACellThatAnotherSpoiltIsTriedAgainInAFreshWorker) {
  // Every second fit of a process crashes; every cell must get through all the same.
  write_text(folder_ / "grid.toml", R"([grid]
problems = ["A/j2/no_load"]
methods = ["test_flaky"]
seeds = { first = 1, count = 9 }
)");
  ASSERT_EQ(run_to_end({test_program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                        (folder_ / "run").string(), "--jobs", "1"})
                .status,
            0);
  for (const auto& [cell, status] : column_of(folder_ / "run", "status")) {
    EXPECT_EQ(status, "ok") << cell;
  }
}

TEST_F(MisbehavingMethodsTest, AQuarantinedCellIsNotRunAndSaysSo) {
  const std::map<std::string, std::string> reasons = run(R"([grid]
problems = ["A/j2/no_load"]
methods = ["test_mean", "test_hang"]
quarantine = ["*|test_hang|*"]
)");
  EXPECT_EQ(reasons.at("test_hang"), "quarantined");
  EXPECT_EQ(reasons.at("test_mean"), "");
}

TEST_F(MisbehavingMethodsTest, WhatCrashedIsListedForTheNextRunsQuarantine) {
  const std::string grid = R"([grid]
problems = ["A/j2/no_load"]
methods = ["test_mean", "test_crash", "test_throw"]
)";
  run(grid);
  const std::filesystem::path list = folder_ / "run" / "quarantine.txt";
  EXPECT_EQ(read_text(list), "A/j2/no_load|test_crash|-|1\n");
  ASSERT_EQ(run_to_end({test_program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                        (folder_ / "next").string(), "--quarantine", list.string()})
                .status,
            0);
  EXPECT_EQ(column_of(folder_ / "next", "reason").at("A/j2/no_load|test_crash|-|1"), "quarantined");
  // A line that leaves out no cell is said, and is not what goes on as the run's grid.
  write_text(list, read_text(list) + "A/j3/*|test_mean|*\n");
  const ProgramRun more =
      run_to_end({test_program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                  (folder_ / "more").string(), "--quarantine", list.string()});
  EXPECT_EQ(more.status, 0);
  EXPECT_THAT(more.errors, ::testing::HasSubstr("1 of 2 lines leave out no cell of this grid; the "
                                                "first is 'A/j3/*|test_mean|*'"));
  EXPECT_EQ(run_to_end({test_program().string(), "run", (folder_ / "more/grid.toml").string(),
                        "--out", (folder_ / "more").string(), "--resume"})
                .status,
            0);
}

TEST_F(MisbehavingMethodsTest, AFullDiskIsSaidAndLosesNothing) {
  write_text(folder_ / "grid.toml", R"([grid]
problems = ["A/j2/no_load"]
methods = ["test_mean"]
seeds = { first = 1, count = 40 }
)");
  const std::vector<std::string> command = {test_program().string(),
                                            "run",
                                            (folder_ / "grid.toml").string(),
                                            "--out",
                                            (folder_ / "run").string(),
                                            "--jobs",
                                            "2"};
  // A limit on the size of files stands for a full disk: 16 blocks of 1 KiB.
  std::string limited = "ulimit -f 16; exec \"$@\"";
  std::vector<std::string> in_shell = {"bash", "-c", limited, "bash"};
  in_shell.insert(in_shell.end(), command.begin(), command.end());
  const ProgramRun full = run_to_end(in_shell);
  EXPECT_EQ(full.status, 3);
  EXPECT_THAT(full.errors, HasSubstr("cells.jsonl"));
  EXPECT_THAT(full.errors, HasSubstr("--resume"));
  std::vector<std::string> resume = command;
  resume.push_back("--resume");
  const ProgramRun resumed = run_to_end(resume);
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_THAT(resumed.errors, ::testing::Not(HasSubstr("damaged")));
  EXPECT_EQ(column_of(folder_ / "run", "status").size(), 40U);
}

}  // namespace
}  // namespace tribench::testing
