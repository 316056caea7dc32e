// SPDX-License-Identifier: MIT
//
// A user's own files from the command line to a leaderboard, by an option and by a grid.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kOwnGrid = R"([grid]
name = "mine"
methods = ["linear", "test_search"]

[budget]
evaluations = 20_000

[[problem]]
folder = "logs"
target = "tau"
inputs = ["v", "load"]
group = "campaign"
)";

class OwnDataTest : public ::testing::Test {
 protected:
  void SetUp() override { fill(folder_ / "here"); }

  // The same files and grid in a folder of their own: another machine, as far as paths go.
  static void fill(const fs::path& place) {
    fs::create_directories(place / "logs");
    for (int k = 0; k < 5; ++k) {
      std::string text = "v,load,tau,campaign\n";
      for (int r = 0; r < 20; ++r) {
        const double v = std::sin(r + k);
        text += std::to_string(v) + "," + std::to_string(r % 5) + "," +
                std::to_string((k + 1) * v + 0.1 * (r % 5)) + "," + "pqrst"[r / 4] + "\n";
      }
      write_text(place / "logs" / ("joint " + std::to_string(k) + ".csv"), text);
    }
    write_text(place / "grid.toml", kOwnGrid);
  }

  static ProgramRun run(const std::vector<std::string>& words) {
    std::vector<std::string> command = {test_program().string()};
    command.insert(command.end(), words.begin(), words.end());
    return run_to_end(command);
  }
  ProgramRun run_grid(const std::string& place, const std::string& out,
                      const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"run", (folder_ / place / "grid.toml").string(), "--out",
                                      (folder_ / place / out).string(), "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  TemporaryFolder folder_;
};

TEST_F(OwnDataTest, AFolderOfFilesBecomesALeaderboardInOneCommand) {
  const fs::path out = folder_ / "board";
  const ProgramRun done =
      run({"run", "--data-file", (folder_ / "here/logs").string(), "--target", "tau", "--inputs",
           "v,load", "--methods", "linear,constant", "--out", out.string(), "--quiet"});
  ASSERT_EQ(done.status, 0) << done.errors;
  const std::string board = read_text(out / "leaderboard.md");
  for (int k = 0; k < 5; ++k) EXPECT_THAT(board, HasSubstr("joint_" + std::to_string(k)));
  EXPECT_EQ(column_of(out, "status").size(), 10U);
  for (const auto& [cell, formula] : column_of(out, "formula")) {
    if (cell.find("|linear|") != std::string::npos) EXPECT_THAT(formula, HasSubstr("load"));
  }
  // Together they are one problem, a file held out.
  const ProgramRun one =
      run({"run", "--data-file", (folder_ / "here/logs").string(), "--target", "tau", "--inputs",
           "v,load", "--methods", "linear", "--together", "campaign", "--seeds", "3", "--out",
           (folder_ / "one").string(), "--quiet"});
  ASSERT_EQ(one.status, 0) << one.errors;
  EXPECT_EQ(column_of(folder_ / "one", "status").size(), 3U);
}

TEST_F(OwnDataTest, AFileOfTheFolderThatTestsIsNoProblem) {
  const std::string logs = (folder_ / "here/logs").string();
  const auto run_on = [&](const std::string& files, const std::string& out) {
    return run({"run", "--data-file", files, "--target", "tau", "--inputs", "v,load", "--methods",
                "linear", "--test", logs + "/joint 2.csv", "--out", (folder_ / out).string(),
                "--quiet"});
  };
  const ProgramRun done = run_on(logs, "rest");
  ASSERT_EQ(done.status, 0) << done.errors;
  const auto status = column_of(folder_ / "rest", "status");
  EXPECT_EQ(status.size(), 4U);
  for (const auto& [cell, text] : status) EXPECT_EQ(cell.find("joint_2"), std::string::npos);
  const ProgramRun refused = run_on(logs + "/joint 2.csv", "itself");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr("--test"), HasSubstr("joint 2.csv' trains")));
}

// What a method says it lacks can be given by doing what the message says.
TEST_F(OwnDataTest, AMissingRoleIsToldWithItsMend) {
  const auto run_with = [this](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run",
                                      "--data-file",
                                      (folder_ / "here/logs/joint 0.csv").string(),
                                      "--target",
                                      "tau",
                                      "--inputs",
                                      "v,load",
                                      "--methods",
                                      "symmetric,lugre",
                                      "--out",
                                      (folder_ / name).string(),
                                      "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  run_with("without", {});
  const auto reasons = column_of(folder_ / "without", "reason");
  ASSERT_EQ(reasons.size(), 2U);
  for (const auto& [cell, reason] : reasons) {
    EXPECT_THAT(reason, AllOf(HasSubstr("with role velocity"),
                              HasSubstr("roles = \"COLUMN=velocity\" in its [[problem]]"),
                              HasSubstr("--roles COLUMN=velocity")));
  }
  run_with("with", {"--roles", "v=velocity"});
  for (const auto& [cell, reason] : column_of(folder_ / "with", "reason")) {
    if (cell.find("|symmetric|") != std::string::npos) EXPECT_EQ(reason, "");
    if (cell.find("|lugre|") != std::string::npos) {
      EXPECT_THAT(reason, HasSubstr("roles = \"COLUMN=time\" in its [[problem]]"));
    }
  }
}

// The pictures of the page, as `report --pictures` writes them.
TEST_F(OwnDataTest, ARunWritesItsPictures) {
  if (std::system("command -v node >/dev/null 2>&1 && command -v rsvg-convert >/dev/null 2>&1") !=
      0) {
    GTEST_SKIP() << "no node or no rsvg-convert";
  }
  // Two files will do: a picture takes a tenth of a second.
  for (const int k : {2, 3, 4}) {
    fs::remove(folder_ / ("here/logs/joint " + std::to_string(k) + ".csv"));
  }
  const fs::path pictures = folder_ / "my pictures";
  const ProgramRun done = run_grid("here", "out", {"--pictures", pictures.string()});
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("pictures in " + pictures.string()));
  const fs::path again = folder_ / "again";
  ASSERT_EQ(run({"report", (folder_ / "here/out").string(), "--pictures", again.string()}).status,
            0);
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(again)) {
    EXPECT_EQ(read_text(pictures / entry.path().filename()), read_text(entry.path()));
    ++count;
  }
  EXPECT_GE(count, 2U);
}

TEST_F(OwnDataTest, AnotherMachineGivesTheSameBytes) {
  ASSERT_EQ(run_grid("here", "out", {"--jobs", "2"}).status, 0);
  fill(folder_ / "elsewhere/deeper");
  ASSERT_EQ(run_grid("elsewhere/deeper", "out", {"--jobs", "1"}).status, 0);
  const fs::path here = folder_ / "here/out";
  const fs::path there = folder_ / "elsewhere/deeper/out";
  EXPECT_EQ(timeless_results(here), timeless_results(there));
  for (const char* file : {"grid.toml", "planned.csv", "front.csv", "curves.csv"}) {
    EXPECT_EQ(read_text(here / file), read_text(there / file)) << file;
  }
  const auto provenance = nlohmann::json::parse(read_text(here / "provenance.json"));
  ASSERT_EQ(provenance.at("files").size(), 5U);
  const std::string hash = provenance.at("files")[0].at("sha256");
  EXPECT_THAT(read_text(here / "results.csv"), HasSubstr("joint_0@" + hash.substr(0, 12) + "|"));
}

TEST_F(OwnDataTest, TheCommandIsKeptAsItCanBeTypedAgain) {
  ASSERT_EQ(run_grid("here", "two words").status, 0);
  const auto provenance =
      nlohmann::json::parse(read_text(folder_ / "here" / "two words" / "provenance.json"));
  const std::string line = provenance.at("sessions")[0].at("command_line");
  EXPECT_THAT(line, HasSubstr("here/two words'"));
}

TEST_F(OwnDataTest, ShardsOnDifferentMachinesMerge) {
  fill(folder_ / "elsewhere/deeper");
  ASSERT_EQ(run_grid("here", "whole").status, 0);
  ASSERT_EQ(run_grid("here", "half", {"--shard", "1/2"}).status, 0);
  ASSERT_EQ(run_grid("elsewhere/deeper", "half", {"--shard", "2/2"}).status, 0);
  const fs::path merged = folder_ / "merged";
  const ProgramRun merge =
      run({"merge", (folder_ / "here/half").string(), (folder_ / "elsewhere/deeper/half").string(),
           "--out", merged.string()});
  ASSERT_EQ(merge.status, 0) << merge.errors;
  EXPECT_EQ(timeless_results(merged), timeless_results(folder_ / "here/whole"));
  EXPECT_EQ(read_text(merged / "curves.csv"), read_text(folder_ / "here/whole/curves.csv"));
  // The merged folder's grid finds the files, too.
  const ProgramRun again = run(
      {"run", (merged / "grid.toml").string(), "--out", merged.string(), "--resume", "--quiet"});
  EXPECT_EQ(again.status, 0) << again.errors;
}

TEST_F(OwnDataTest, AFileThatChangedIsRefusedAndLeavesNoRecord) {
  ASSERT_EQ(run_grid("here", "out").status, 0);
  const std::string before = read_text(folder_ / "here/out/results.csv");
  std::ofstream(folder_ / "here/logs/joint 3.csv", std::ios::app) << "9,9,9,p\n";
  const ProgramRun resumed = run_grid("here", "out", {"--resume"});
  EXPECT_EQ(resumed.status, 2);
  EXPECT_THAT(resumed.errors, HasSubstr("another run"));
  const ProgramRun by_folder = run({"run", (folder_ / "here/out/grid.toml").string(), "--out",
                                    (folder_ / "here/out").string(), "--resume", "--quiet"});
  EXPECT_EQ(by_folder.status, 2);
  EXPECT_THAT(by_folder.errors, AllOf(HasSubstr("joint 3.csv"), HasSubstr("has changed")));
  EXPECT_EQ(read_text(folder_ / "here/out/results.csv"), before);
}

TEST_F(OwnDataTest, AFileThatChangesUnderTheRunStopsIt) {
  // The method spoils the file that the next cells need.
  write_text(folder_ / "here/method.sh", "sleep 0.2; echo 9,9,9,p >> '" +
                                             (folder_ / "here/logs/joint 4.csv").string() +
                                             "'; echo '{\"front\": [\"v\"]}'\n");
  write_text(folder_ / "here/grid.toml",
             "[grid]\nmethods = [\"spoils\"]\nseeds = { first = 1, count = 2 }\n"
             "[[external]]\nname = \"spoils\"\ncommand = [\"bash\", \"" +
                 (folder_ / "here/method.sh").string() +
                 "\"]\n[[problem]]\nfile = \"logs/joint 4.csv\"\ntarget = \"tau\"\n"
                 "inputs = [\"v\"]\n");
  const ProgramRun stopped = run_grid("here", "out", {"--jobs", "1"});
  EXPECT_EQ(stopped.status, 3);
  EXPECT_THAT(stopped.errors, HasSubstr("has changed"));
}

TEST_F(OwnDataTest, SlurmElementsAreToldTheSameFiles) {
  const ProgramRun plan = run({"submit", (folder_ / "here/grid.toml").string(), "--slurm", "--out",
                               (folder_ / "run").string(), "--shards", "2", "--dry-run"});
  ASSERT_EQ(plan.status, 0) << plan.errors;
  EXPECT_THAT(plan.output, HasSubstr("grid.toml"));
  const ProgramRun dry = run({"run", (folder_ / "here/grid.toml").string(), "--dry-run", "--out",
                              (folder_ / "run").string()});
  ASSERT_EQ(dry.status, 0);
  EXPECT_THAT(dry.output, HasSubstr("joint_2@"));
  // What an element runs: the run folder's own grid.
  const ProgramRun element = run({"run", (folder_ / "run/grid.toml").string(), "--out",
                                  (folder_ / "run/shard-1").string(), "--shard", "1/2", "--quiet"});
  EXPECT_EQ(element.status, 0) << element.errors;
}

// In a path Slurm would write %j as the job's number, and sbatch takes quotes and hashes for its
// own.
TEST_F(OwnDataTest, SlurmWritesItsLogsWhereTheRunIs) {
  const std::string out = (folder_ / "r\xc3\xa9sultat#%j'").string();
  const ProgramRun plan =
      run({"submit", (folder_ / "here/grid.toml").string(), "--slurm", "--out", out, "--dry-run"});
  ASSERT_EQ(plan.status, 0) << plan.errors;
  EXPECT_THAT(plan.output, HasSubstr("r\xc3\xa9sultat#%%j'/log/element-%a.log\""));
}

TEST_F(OwnDataTest, AnSbatchThatNamesNoJobIsNotBelieved) {
  write_text(folder_ / "bin/sbatch", "#!/bin/sh\necho submitted\n");
  fs::permissions(folder_ / "bin/sbatch", fs::perms::owner_all);
  const ProgramRun answer = run_to_end(
      {program().string(), "submit", "quick", "--slurm", "--out", (folder_ / "run").string()},
      {"PATH=" + (folder_ / "bin").string() + ":" + std::getenv("PATH")});
  EXPECT_EQ(answer.status, 3);
  EXPECT_THAT(answer.errors, HasSubstr("'submitted', which is no job's number"));
}

TEST_F(OwnDataTest, RefusalsNameOptionAndMend) {
  const std::string logs = (folder_ / "here/logs").string();
  const auto refused = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "run");
    const ProgramRun answer = run(words);
    EXPECT_EQ(answer.status, 2);
    return answer.errors;
  };
  EXPECT_THAT(refused({"--data-file", logs}), HasSubstr("--target"));
  EXPECT_THAT(refused({"--target", "tau"}), HasSubstr("--data-file"));
  EXPECT_THAT(refused({"quick", "--data-file", logs, "--target", "tau"}), HasSubstr("excludes"));
  EXPECT_THAT(refused({"--data-file", logs + "/none.csv", "--target", "tau"}),
              AllOf(HasSubstr("--data-file"), HasSubstr("none.csv")));
  const std::string latin = (folder_ / "here/p\xe9riode.csv").string();
  write_text(latin, "v,tau\n1,2\n2,4\n");
  EXPECT_THAT(refused({"--data-file", latin, "--target", "tau", "--inputs", "v"}),
              HasSubstr("not UTF-8; rename it"));
  EXPECT_THAT(refused({"--data-file", logs, "--target", "tau", "--methods", "linaer"}),
              HasSubstr("linear"));
  EXPECT_THAT(refused({"--data-file", logs, "--target", "tua", "--methods", "linear"}),
              AllOf(HasSubstr("tau"), HasSubstr("joint 0.csv")));
  EXPECT_THAT(refused({"--data-file", logs, "--target", "tau", "--split", "1.5"}),
              HasSubstr("--split"));
}

// tau = a sgn(v) + b v, with a and b of each axis's own; every third row tests.
class CategoryGridTest : public OwnDataTest {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "here");
    const double constants[3][2] = {{3, 2}, {0.02, 0.5}, {40, 10}};
    std::string text = "t,v,axis,fold,tau\n";
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 60; ++i) {
        const double v = -1.97 + 0.0667 * i;
        const double tau = (v > 0 ? 1 : -1) * constants[k][0] + constants[k][1] * v;
        text += fmt::format("{},{},{},{},{}\n", 100 * k + i, v, k + 4, i % 3,
                            tau + 1e-3 * std::sin(9.7 * i + k));
      }
    }
    write_text(folder_ / "here/axes.csv", text);
  }
  void write_grid(const std::string& methods, const std::string& more) const {
    write_text(folder_ / "here/grid.toml", "[grid]\nmethods = [" + methods +
                                               "]\n[budget]\nevaluations = 3e7\n"
                                               "[[problem]]\nname = \"axes\"\nfile = \"axes.csv\"\n"
                                               "target = \"tau\"\ninputs = [\"v\", \"sgn_v\"]\n" +
                                               more);
  }
};

TEST_F(CategoryGridTest, OneShapeIsJudgedOnTheRowsOfAllCategories) {
  const std::string split = "split = { column = \"fold\", values = [\"2\"] }\n";
  write_grid("\"linear\", \"pysr\"", split + "category = \"axis\"\n");
  const ProgramRun done = run_grid("here", "out");
  ASSERT_EQ(done.status, 0) << done.errors;
  for (const auto& [cell, formula] : column_of(folder_ / "here/out", "formula")) {
    EXPECT_THAT(formula, AllOf(HasSubstr("p1()"), HasSubstr("; axis=4: p1()="),
                               HasSubstr("; axis=5: p1()="), HasSubstr("; axis=6: p1()=")))
        << cell;
  }
  for (const auto& [cell, error] : column_of(folder_ / "here/out", "mae_test")) {
    EXPECT_LT(std::stod(error), 2e-3) << cell;
  }
  for (const auto& [cell, verdict] : column_of(folder_ / "here/out", "singularity")) {
    EXPECT_EQ(verdict, "proved_free") << cell;
  }
  // The same again, and of the grid that the run wrote; without categories no formula will do.
  ASSERT_EQ(run_grid("here", "again", {"--jobs", "2"}).status, 0);
  EXPECT_EQ(column_of(folder_ / "here/again", "formula"),
            column_of(folder_ / "here/out", "formula"));
  EXPECT_THAT(read_text(folder_ / "here/out/grid.toml"), HasSubstr("category = 'axis'"));
  write_grid("\"pysr\"", split);
  run_grid("here", "together");
  for (const auto& [cell, error] : column_of(folder_ / "here/together", "mae_test")) {
    EXPECT_GT(std::stod(error), 1) << cell;
  }
}

TEST_F(CategoryGridTest, WhatHasNoShapeOfItsOwnSaysSo) {
  write_grid("\"linear\", \"dahl\"", "category = \"axis\"\nroles = \"v=velocity,t=time\"\n");
  run_grid("here", "out");
  for (const auto& [cell, reason] : column_of(folder_ / "here/out", "reason")) {
    const bool has_memory = cell.find("|dahl|") != std::string::npos;
    EXPECT_THAT(reason, has_memory ? HasSubstr("leave out 'category'") : HasSubstr(""));
    EXPECT_EQ(reason.empty(), !has_memory) << reason;
    EXPECT_EQ(reason.starts_with("unsupported"), has_memory) << reason;
  }
  // A category whose rows all test has no constants.
  write_grid("\"linear\"",
             "category = \"axis\"\nsplit = { column = \"axis\", values = [\"5\"] }\n");
  run_grid("here", "none");
  for (const auto& [cell, reason] : column_of(folder_ / "here/none", "reason")) {
    EXPECT_THAT(reason,
                AllOf(HasSubstr("category 5"), HasSubstr("split each category's own rows")));
  }
}

}  // namespace
}  // namespace tribench::testing
