// SPDX-License-Identifier: MIT
//
// generate, data, report and study, as a user calls them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "problems/reading/csv.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(GenerateCommand, WritesWhatReadsBackAndTheSameForTheSameSeed) {
  const TemporaryFolder folder;
  const std::string one = (folder / "one.csv").string();
  const std::string two = (folder / "two.csv").string();
  ASSERT_EQ(run_tribench({"generate", "undeclared/stribeck/1", "--seed", "3", "--out", one}).status,
            0);
  ASSERT_EQ(run_tribench({"generate", "undeclared/stribeck/1", "--seed", "3", "--out", two}).status,
            0);
  EXPECT_EQ(read_text(one), read_text(two));
  const Dataset data = read_csv(one).data;
  EXPECT_EQ(data.movement_names.size(), 108U);
  for (const Role role :
       {Role::time, Role::position, Role::velocity, Role::acceleration, Role::gravity_torque,
        Role::temperature, Role::other_velocity, Role::other_acceleration, Role::friction_torque}) {
    EXPECT_NE(data.find(role), nullptr) << role_name(role);
  }
}

TEST(GenerateCommand, RefusesWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  const std::string out = (folder / "x.csv").string();
  EXPECT_EQ(run_tribench({"generate", "A/j3/load", "--out", out}).status, 2);
  EXPECT_EQ(run_tribench({"generate", "A/j2/load", "--seed", "-1", "--out", out}).status, 2);
  EXPECT_EQ(run_tribench({"generate", "A/j2/load"}).status, 2);
}

TEST(GenerateCommand, ProblemsWithoutARecordingGiveTheirTables) {
  const TemporaryFolder folder;
  const std::string out = (folder / "n.csv").string();
  ASSERT_EQ(run_tribench({"generate", "nguyen/1", "--out", out}).status, 0);
  EXPECT_GE(read_csv(out).data.rows(), 20U);
}

TEST(MergeCommand, KeepsWhatTheSuitesSay) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  write_text(folder / "grid.toml",
             "[grid]\nproblems = [\"nguyen/1\", \"nguyen/2\"]\nmethods = [\"linear\"]\n");
  for (const char* shard : {"1/2", "2/2"}) {
    const char* out = shard[0] == '1' ? "first" : "second";
    ASSERT_EQ(run_tribench({"run", path("grid.toml"), "--shard", shard, "--out", path(out)}).status,
              0);
  }
  ASSERT_EQ(run_tribench({"run", path("grid.toml"), "--out", path("whole")}).status, 0);
  ASSERT_EQ(run_tribench({"merge", path("first"), path("second"), "--out", path("all")}).status, 0);
  EXPECT_EQ(read_text(folder / "all/suites.json"), read_text(folder / "whole/suites.json"));
  EXPECT_THAT(read_text(folder / "all/leaderboard.md"), HasSubstr("## Suites"));
}

TEST(MergeCommand, SaysWhatIsMissingAndWhatIsThereTwice) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  write_text(folder / "grid.toml",
             "[grid]\nproblems = [\"nguyen/1\", \"nguyen/2\"]\nmethods = [\"linear\"]\n"
             "operators = [\"paper\"]\nseeds = { first = 1, count = 2 }\n");
  ASSERT_EQ(
      run_tribench({"run", path("grid.toml"), "--shard", "1/2", "--out", path("first")}).status, 0);
  const ProgramRun part = run_tribench({"merge", path("first"), "--out", path("part")});
  EXPECT_EQ(part.status, 4);
  EXPECT_THAT(part.errors, HasSubstr("2 of 4 planned cells are missing, the first "));
  const ProgramRun again = run_tribench({"merge", path("first"), "--out", path("part")});
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, AllOf(HasSubstr("there is a run in this folder already"),
                                  HasSubstr("give another --out"), Not(HasSubstr("--resume"))));
  const std::string same = path("first") + "/../first";
  const ProgramRun twice = run_tribench({"merge", path("first"), same, "--out", path("twice")});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.errors, HasSubstr(same + ": this folder is named twice"));
  ASSERT_EQ(run_tribench({"run", path("grid.toml"), "--out", path("whole")}).status, 0);
  const ProgramRun both =
      run_tribench({"merge", path("first"), path("whole"), "--out", path("both")});
  EXPECT_EQ(both.status, 0);
  EXPECT_THAT(both.errors, HasSubstr("2 results are in more than one folder"));
}

TEST(DataCommand, ListsWithoutDataAndFindsAChangedFile) {
  const TemporaryFolder folder;
  const auto list = run_tribench({"data", "list", "--json"});
  EXPECT_EQ(list.status, 0);
  EXPECT_EQ(nlohmann::json::parse(list.output).size(), 6U);
  std::filesystem::create_directories(folder / "emps");
  write_text(folder / "emps/emps_estimation.csv", "not it");
  const auto check = run_tribench({"data", "check", "--data", folder.path().string()});
  EXPECT_EQ(check.status, 1);
  EXPECT_THAT(check.output, HasSubstr("changed  emps/emps_estimation.csv"));
  EXPECT_THAT(check.output, HasSubstr("missing  emps/emps_validation_pulses.csv"));
  EXPECT_EQ(run_tribench({"data", "check", "--data", (folder / "none").string()}).status, 2);
  EXPECT_EQ(run_tribench({"data", "add", "emps", "--from", folder.path().string(), "--data",
                          (folder / "to").string()})
                .status,
            2);
}

TEST(StudyCommand, GeneratorAnswersInJson) {
  const auto study = run_tribench({"study", "generator", "--seeds", "1", "--json"});
  EXPECT_EQ(nlohmann::json::parse(study.output).size(), 26U);
  EXPECT_EQ(run_tribench({"study", "generator", "--seeds", "0"}).status, 2);
}

TEST(StudyCommand, AProgramThatDoesNotAnswerIsEndedAfterItsTime) {
  const TemporaryFolder folder;
  write_text(folder / "sleeper.sh", "sleep 100\n");
  const auto start = std::chrono::steady_clock::now();
  const auto study =
      run_tribench({"study", "loop", "--only", "single/stribeck", "--runs", "1", "--per-cell", "1",
                    "--jobs", "1", "--command-seconds", "0.2", "--out", (folder / "study").string(),
                    "--command", "sh", (folder / "sleeper.sh").string()});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  EXPECT_NE(study.status, 0);
  EXPECT_THAT(study.errors, HasSubstr("longer than 0.2 s"));
}

// Effects of a hundredth of the noise are not found: the log's story is wrong.
TEST(StudyCommand, KeepsTheLogsOfWrongStoriesWhateverItPrints) {
  const TemporaryFolder folder;
  const std::string out = (folder / "wrong logs").string();
  const auto study = run_tribench({"study", "logs", "--logs", "1", "--seed", "2", "--scale", "0.01",
                                   "--seconds", "10", "--clean-only", "--json", "--out", out});
  const std::string file = out + "/viscous_power_2_cleanly.csv";
  const nlohmann::json log = nlohmann::json::parse(study.output).at("logs").at(0);
  EXPECT_THAT(log.at("repeat").get<std::string>(),
              HasSubstr("tribench loop '" + file + "' --gear-ratio"));
  EXPECT_GT(read_csv(file).data.rows(), 100U);
}

TEST(StudyCommand, AFolderThatCannotBeMadeIsFoundBeforeTheWork) {
  const TemporaryFolder folder;
  write_text(folder / "file", "");
  for (const std::string study : {"loop", "explore", "logs", "retellings"}) {
    const auto run = run_tribench({"study", study, "--out", (folder / "file/below").string()});
    EXPECT_THAT(run.errors, HasSubstr("choose a folder that can be written to")) << study;
    EXPECT_TRUE(run.output.empty()) << study;
  }
}

// A run's pictures are drawn again from the measured rows, which its folder does not have.
TEST(ReportCommand, FindsTheMeasuredRowsWhereItIsTold) {
  const auto data = shared_data();
  if (!data) GTEST_SKIP() << kNoSharedData;
  const TemporaryFolder folder;
  const std::string run = (folder / "run").string();
  write_text(folder / "grid.toml",
             "[grid]\nname = \"measured\"\nproblems = [\"emps/estimation\"]\n"
             "methods = [\"linear\"]\noperators = [\"paper\"]\nseeds = { first = 1, count = 1 }\n");
  ASSERT_EQ(run_tribench({"run", (folder / "grid.toml").string(), "--data", data->string(), "--out",
                          run, "--quiet"})
                .status,
            0);
  const std::string drawn = read_text(folder / "run/curves.csv");
  ASSERT_THAT(drawn, HasSubstr("measured rows"));
  const std::string nowhere = (folder / "nowhere").string();
  const ProgramRun kept = run_tribench({"report", run, "--data", nowhere});
  EXPECT_EQ(kept.status, 0);
  EXPECT_THAT(kept.errors, HasSubstr("the pictures of emps/estimation are those of the run"));
  EXPECT_EQ(read_text(folder / "run/curves.csv"), drawn);
  std::filesystem::remove(folder / "run/curves.csv");
  EXPECT_EQ(run_tribench({"report", run, "--data", data->string()}).errors, "");
  EXPECT_EQ(read_text(folder / "run/curves.csv"), drawn);
  const std::string joined = (folder / "joined").string();
  EXPECT_EQ(run_tribench({"merge", run, "--out", joined, "--data", data->string()}).errors, "");
  EXPECT_EQ(read_text(folder / "joined/curves.csv"), drawn);
}

// Killed before it wrote its tables, a run has what its journal has.
TEST(CompareCommand, ReadsTheJournalOfARunThatWasKilled) {
  const TemporaryFolder folder;
  const std::string data = (folder / "d.csv").string();
  std::string rows = "x,y\n";
  for (int k = 0; k < 40; ++k) rows += fmt::format("{},{}\n", k, 2 * k + k % 3);
  write_text(data, rows);
  const std::string run = (folder / "run").string();
  ASSERT_EQ(run_tribench(
                {"run", "--data-file", data, "--target", "y", "--methods", "linear", "--out", run})
                .status,
            0);
  for (const char* table : {"results.csv", "front.csv"}) {
    std::filesystem::remove(folder / "run" / table);
  }
  const ProgramRun compared = run_tribench({"compare", run, run});
  EXPECT_EQ(compared.output.find("no cell in common"), std::string::npos) << compared.output;
}

}  // namespace
}  // namespace tribench::testing
