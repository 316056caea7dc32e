// SPDX-License-Identifier: MIT
//
// The same grid gives the same results, byte for byte, however it is run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <thread>

#include "foundation/child_process.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;

constexpr const char* kGrid = R"([grid]
name = "small"
problems = ["A/j2/no_load", "A/j4/load", "B/j2/load"]
methods = ["test_mean", "test_search", "test_sleep"]
operators = ["paper", "paper+div"]
seeds = { first = 1, count = 2 }

[budget]
evaluations = 2_000_000
seconds = 20

[[method]]
name = "test_sleep"
parameters = { seconds = 0.1 }
)";
constexpr std::size_t kCells = 3 * (1 + 2 + 1) * 2;

class RunTest : public ::testing::Test {
 protected:
  void SetUp() override { write_text(folder_ / "grid.toml", kGrid); }

  ProgramRun run(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> command = {test_program().string(), "run",
                                        (folder_ / "grid.toml").string(), "--out",
                                        (folder_ / out).string()};
    command.insert(command.end(), more.begin(), more.end());
    return run_to_end(command);
  }

  // A finished run of the grid by two jobs in a folder of the test's own. Made once: those who only
  // look at one need not wait for another.
  void copy_finished_run(const std::string& out) {
    if (!finished_) {
      finished_ = std::make_unique<TemporaryFolder>();
      ASSERT_EQ(run((*finished_ / "run").string(), {"--jobs", "2"}).status, 0);
    }
    std::filesystem::copy(*finished_ / "run", folder_ / out,
                          std::filesystem::copy_options::recursive);
  }
  static void TearDownTestSuite() { finished_.reset(); }

  TemporaryFolder folder_;

 private:
  static inline std::unique_ptr<TemporaryFolder> finished_;
};

TEST_F(RunTest, OneAndTwoThreadsGiveTheSameResults) {
  ASSERT_EQ(run("one", {"--jobs", "1"}).status, 0);
  copy_finished_run("two");
  EXPECT_EQ(column_of(folder_ / "one", "status").size(), kCells);
  EXPECT_EQ(timeless_results(folder_ / "one"), timeless_results(folder_ / "two"));
  EXPECT_EQ(read_text(folder_ / "one" / "front.csv"), read_text(folder_ / "two" / "front.csv"));
}

// The C library picks its kernels by the processor: exp, log, pow, sin ... of a machine without a
// fused multiply-add have other last bits. GLIBC_TUNABLES makes this machine such a one.
TEST_F(RunTest, OtherKernelsOfTheCLibraryGiveTheSameResults) {
  write_text(folder_ / "every.toml", R"([grid]
name = "every_method"
problems = ["A/j2/no_load", "B/j2/load", "nguyen/7", "nguyen/11"]
methods = ["*"]
operators = ["full"]
seeds = { first = 1, count = 1 }

[budget]
evaluations = 2_000_000
seconds = 60
)");
  const auto run_every = [&](const std::string& out, const std::vector<std::string>& environment) {
    return run_to_end({program().string(), "run", (folder_ / "every.toml").string(), "--out",
                       (folder_ / out).string(), "--quiet"},
                      environment)
        .status;
  };
  ASSERT_EQ(run_every("usual", {}), 0);
  ASSERT_EQ(run_every("plain", {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4"}), 0);
  EXPECT_GE(column_of(folder_ / "usual", "status").size(), 28U);
  EXPECT_EQ(timeless_results(folder_ / "usual"), timeless_results(folder_ / "plain"));
  EXPECT_EQ(read_text(folder_ / "usual" / "front.csv"), read_text(folder_ / "plain" / "front.csv"));
}

TEST_F(RunTest, TwoShardsMergedInAnyOrderGiveTheSameResults) {
  copy_finished_run("whole");
  ASSERT_EQ(run("first", {"--shard", "1/2"}).status, 0);
  ASSERT_EQ(run("second", {"--shard", "2/2"}).status, 0);
  const ProgramRun merged =
      run_to_end({test_program().string(), "merge", (folder_ / "second").string(),
                  (folder_ / "first").string(), "--out", (folder_ / "merged").string()});
  ASSERT_EQ(merged.status, 0) << merged.errors;
  EXPECT_LT(column_of(folder_ / "first", "status").size(), kCells);
  EXPECT_EQ(timeless_results(folder_ / "merged"), timeless_results(folder_ / "whole"));
}

TEST_F(RunTest, KilledHalfWayAndResumedGivesTheSameResults) {
  copy_finished_run("whole");
  const std::string journal = (folder_ / "killed" / "cells.jsonl").string();
  {
    ChildProcess program(
        ChildOptions{{test_program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                      (folder_ / "killed").string(), "--jobs", "2"},
                     // with the keepers of its workers, which remove their temporary files
                     {"TMPDIR=" + (folder_ / ".").string()}});
    // Half the lines of the whole run's journal.
    const std::string whole = read_text(folder_ / "whole" / "cells.jsonl");
    while (read_text(journal).size() < whole.size() / 2) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ::kill(program.pid(), SIGKILL);
    program.wait();
  }
  const std::string half = read_text(journal);
  const ProgramRun refused = run("killed");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--resume"));
  const ProgramRun resumed = run("killed", {"--resume"});
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_TRUE(read_text(journal).starts_with(half.substr(0, half.rfind('\n') + 1)));
  EXPECT_EQ(timeless_results(folder_ / "killed"), timeless_results(folder_ / "whole"));
}

class InterruptedRunTest : public RunTest, public ::testing::WithParamInterface<int> {};

// By Ctrl-C, by the machine, by the end of the terminal.
INSTANTIATE_TEST_SUITE_P(Signals, InterruptedRunTest, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST_P(InterruptedRunTest, LeavesARunThatResumes) {
  ChildProcess program(
      ChildOptions{{test_program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                    (folder_ / "stopped").string(), "--jobs", "1", "--timing"}});
  while (read_text(folder_ / "stopped" / "cells.jsonl").size() < 3000) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ::kill(program.pid(), GetParam());
  std::string errors;
  for (bool ended = false; !ended;) {
    const ChildOutput output = program.read(1.0);
    errors += output.errors;
    ended = output.ended;
  }
  const ChildExit exit = program.wait();
  EXPECT_EQ(exit.signal, 0);
  EXPECT_EQ(exit.status, 3);
  EXPECT_THAT(errors,
              HasSubstr("go on by: tribench run " + (folder_ / "grid.toml").string() + " --out " +
                        (folder_ / "stopped").string() + " --jobs 1 --timing --resume"));
  if (GetParam() == SIGINT) EXPECT_THAT(errors, HasSubstr("Ctrl-C again stops at once"));
  const std::size_t before = column_of(folder_ / "stopped", "status").size();
  EXPECT_GT(before, 0U);
  EXPECT_LT(before, kCells);
  ASSERT_EQ(run("stopped", {"--resume"}).status, 0);
  EXPECT_EQ(column_of(folder_ / "stopped", "status").size(), kCells);
}

TEST_F(RunTest, ResumingAnotherGridIsRefusedWithTheDifference) {
  copy_finished_run("run");
  std::string other = kGrid;
  other.replace(other.find("2_000_000"), 9, "3_000_000");
  write_text(folder_ / "grid.toml", other);
  const ProgramRun refused = run("run", {"--resume"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("- evaluations = 2000000"));
  EXPECT_THAT(refused.errors, HasSubstr("+ evaluations = 3000000"));
}

// Started by a shell that has gone, so that nobody but the run's own keepers clears up.
TEST_F(RunTest, NothingOutlivesARunThatIsKilled) {
  const std::string pids = (folder_ / "pids").string();
  write_text(folder_ / "grid.toml",
             "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"escapes\"]\n[[external]]\n"
             "name = \"escapes\"\ncommand = [\"bash\", \"-c\", \"echo $$ >> " +
                 pids + "; setsid sleep 987 & setsid -f bash -c 'echo $$ >> " + pids +
                 "; sleep 987'; sleep 987\"]\n");
  const std::string line = "TMPDIR=" + folder_.path().string() + " '" + test_program().string() +
                           "' run " + (folder_ / "grid.toml").string() + " --out " +
                           (folder_ / "killed").string() +
                           " --jobs 1 > /dev/null 2>&1 & echo $! > " + (folder_ / "run").string();
  ASSERT_EQ(std::system(line.c_str()), 0);
  const auto lines = [&pids] {
    const std::string text = read_text(pids);
    return std::count(text.begin(), text.end(), '\n');
  };
  for (int i = 0; i < 1000 && lines() < 2; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(lines(), 2);
  ::kill(std::stoi(read_text(folder_ / "run")), SIGKILL);
  std::istringstream started(read_text(pids));
  for (int pid = 0; started >> pid;) {
    for (int i = 0; i < 500 && is_running(pid); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_FALSE(is_running(pid));
  }
  std::vector<std::string> left;
  for (int i = 0; i < 500; ++i) {
    left.clear();
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename();
      if (name.starts_with("tribench-")) left.push_back(name);
    }
    if (left.empty()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_THAT(left, ::testing::IsEmpty()) << "scratch folders";
}

TEST_F(RunTest, DryRunListsTheCellsAndWritesTheGridThatTakesEffect) {
  const ProgramRun listed = run("dry", {"--dry-run"});
  EXPECT_EQ(listed.status, 0);
  EXPECT_THAT(listed.output, HasSubstr("B/j2/load|test_search|paper+div|2"));
  EXPECT_THAT(listed.output, HasSubstr("24 cells"));
  EXPECT_THAT(read_text(folder_ / "dry" / "grid.toml"), HasSubstr("test_search"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "dry" / "cells.jsonl"));
  // What it writes is a grid that gives the same cells.
  std::filesystem::copy_file(folder_ / "dry" / "grid.toml", folder_ / "effective.toml");
  const ProgramRun again = run_to_end(
      {test_program().string(), "run", (folder_ / "effective.toml").string(), "--dry-run"});
  EXPECT_EQ(again.output, listed.output) << again.errors;
}

TEST_F(RunTest, DryRunGoesByARunThatIsThere) {
  copy_finished_run("before");
  const ProgramRun told = run("dry", {"--dry-run", "--like", (folder_ / "before").string()});
  EXPECT_EQ(told.status, 0) << told.errors;
  EXPECT_THAT(told.output, HasSubstr("by the medians of " + (folder_ / "before").string()));
  EXPECT_THAT(told.output, HasSubstr("24 cells, about "));
  EXPECT_THAT(run("dry", {"--dry-run"}).output, HasSubstr("24 cells, at most "));
}

TEST_F(RunTest, VerifyRunsASampleAgainAndFindsResultsThatDoNotComeOutAgain) {
  copy_finished_run("run");
  const auto verify = [&] {
    return run_to_end({test_program().string(), "run", "--verify", (folder_ / "run").string(),
                       "--sample", "24", "--quiet"});
  };
  const ProgramRun good = verify();
  EXPECT_EQ(good.status, 0) << good.errors;
  EXPECT_THAT(good.output, HasSubstr("24 cells run again, 0 differ"));
  // A journal made with half the budget under a grid file that says the whole.
  std::string other = kGrid;
  other.replace(other.find("2_000_000"), 9, "1_000_000");
  write_text(folder_ / "grid.toml", other);
  ASSERT_EQ(run("other").status, 0);
  std::filesystem::copy_file(folder_ / "run" / "grid.toml", folder_ / "other" / "grid.toml",
                             std::filesystem::copy_options::overwrite_existing);
  const ProgramRun bad = run_to_end({test_program().string(), "run", "--verify",
                                     (folder_ / "other").string(), "--sample", "24", "--quiet"});
  EXPECT_EQ(bad.status, 1) << bad.errors;
  EXPECT_THAT(bad.output, HasSubstr("test_search"));
}

TEST_F(RunTest, ReportRendersTheJournalAgain) {
  copy_finished_run("run");
  const std::string before = read_text(folder_ / "run" / "results.csv");
  const std::string board = read_text(folder_ / "run" / "leaderboard.md");
  std::filesystem::remove(folder_ / "run" / "results.csv");
  std::filesystem::remove(folder_ / "run" / "leaderboard.md");
  ASSERT_EQ(run_to_end({test_program().string(), "report", (folder_ / "run").string()}).status, 0);
  EXPECT_EQ(read_text(folder_ / "run" / "results.csv"), before);
  EXPECT_EQ(read_text(folder_ / "run" / "leaderboard.md"), board);
}

TEST_F(RunTest, ReportWritesTablesForAPaperAndSaysWhatChangedSinceABase) {
  copy_finished_run("run");
  const std::string folder = (folder_ / "run").string();
  const std::string program = test_program().string();
  const std::string tables = (folder_ / "tables.tex").string();
  ASSERT_EQ(run_to_end({program, "report", folder, "--as", "latex", "--out", tables}).status, 0);
  EXPECT_THAT(read_text(tables), HasSubstr("\\begin{tabular}"));
  EXPECT_THAT(run_to_end({program, "report", folder, "--as", "latex"}).output,
              HasSubstr("test\\_search"));
  EXPECT_EQ(run_to_end({program, "report", folder, "--as", "word"}).status, 2);
  EXPECT_EQ(run_to_end({program, "report", folder, "--out", tables}).status, 2);
  const ProgramRun changed = run_to_end({program, "report", folder, "--base", folder});
  EXPECT_EQ(changed.status, 0) << changed.errors;
  EXPECT_THAT(changed.output, HasSubstr("## What changed"));
  EXPECT_THAT(changed.output, HasSubstr("All 24 cells are identical apart from time."));
}

}  // namespace
}  // namespace tribench::testing
