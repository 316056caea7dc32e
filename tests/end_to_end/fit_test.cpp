// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// tau = 3 sgn(v) + 2 v in two movements, exactly.
std::string line_data(double offset) {
  std::string text = "movement,velocity_rad_s,friction_torque_Nm\n";
  for (int i = 0; i < 40; ++i) {
    const double v = -1.95 + 0.1 * i + offset;
    text += (i < 20 ? "down," : "up,") + std::to_string(v) + "," +
            std::to_string((v > 0 ? 3 : -3) + 2 * v) + "\n";
  }
  return text;
}

class FitTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write_text(folder_ / "train.csv", line_data(0));
    write_text(folder_ / "test.csv", line_data(0.02));
  }
  ProgramRun fit(std::vector<std::string> more) {
    more.insert(more.begin(), {"fit", (folder_ / "train.csv").string()});
    return run_tribench(more);
  }
  TemporaryFolder folder_;
};

// As in a grid: words, what the rows are weighed by and what chooses them are no inputs.
TEST_F(FitTest, WithoutInputsTakesEveryOtherColumnOfNumbers) {
  std::string text = "who,a,b,w,kind,y\n";
  for (int i = 1; i <= 40; ++i) {
    text += fmt::format("x{},{},{},1,{},{}\n", i, i, i % 7, i % 2, 2 * i - 3 * (i % 7));
  }
  write_text(folder_ / "train.csv", text);
  const ProgramRun run =
      fit({"--target", "y", "--weights", "w", "--where", "kind=1", "--method", "linear", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(json::parse(run.output).at("inputs"), json({"a", "b"}));
  EXPECT_LT(json::parse(run.output).at("mae_train").get<double>(), 1e-9);
  EXPECT_THAT(run.errors, HasSubstr("every other column of numbers: a, b\n"));
  EXPECT_THAT(fit({"--target", "z"}).errors, HasSubstr("'z'"));
  const ProgramRun pipe = run_tribench({"fit", "/dev/stdin", "--target", "y"});
  EXPECT_EQ(pipe.status, 2);
  EXPECT_THAT(pipe.errors, HasSubstr("give --inputs"));
}

TEST_F(FitTest, FindsAPlantedLineAndJudgesItOnOtherData) {
  const ProgramRun run =
      fit({"--target", "friction_torque_Nm", "--inputs", "velocity_rad_s,sgn_velocity_rad_s",
           "--method", "linear", "--test", (folder_ / "test.csv").string(), "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const json answer = json::parse(run.output);
  EXPECT_LT(answer.at("mae_train").get<double>(), 1e-5);
  EXPECT_LT(answer.at("mae_test").get<double>(), 1e-5);
  EXPECT_EQ(answer.at("singularity"), "proved_free");
  ASSERT_FALSE(answer.at("front").empty());
  for (const char* key : {"formula", "complexity", "nodes", "evaluations", "fit_cpu_s"}) {
    EXPECT_TRUE(answer.contains(key)) << key;
  }
}

// Squares of the target are no doubles: it is scaled inside, and the law is in the user's numbers.
TEST_F(FitTest, FindsALawOfNumbersFarFromOne) {
  std::string text = "m,c,E\n";
  for (int i = 0; i < 60; ++i) {
    const double m = 1e-31 * (1 + i % 7);
    const double c = 1e80 * (2 + i % 11);
    text += fmt::format("{},{},{}\n", m, c, m * c * c / 2);
  }
  write_text(folder_ / "far.csv", text);
  const ProgramRun run =
      run_tribench({"fit", (folder_ / "far.csv").string(), "--target", "E", "--inputs", "m,c",
                    "--method", "pysr", "--operators", "full", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const json answer = json::parse(run.output);
  EXPECT_LT(answer.at("mae_train").get<double>(), 1e-6 * 1e129) << answer.at("formula");
  EXPECT_LE(answer.at("complexity").get<int>(), 6) << answer.at("formula");
}

TEST_F(FitTest, WithoutAMethodRelayIsUsedAndOneMemberThatExplainsTheRowsEndsIt) {
  const ProgramRun run = fit({"--target", "friction_torque_Nm", "--inputs",
                              "velocity_rad_s,sgn_velocity_rad_s", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const json answer = json::parse(run.output);
  EXPECT_LT(answer.at("mae_train").get<double>(), 1e-5);
  const ProgramRun alone =
      fit({"--target", "friction_torque_Nm", "--inputs", "velocity_rad_s,sgn_velocity_rad_s",
           "--method", "relay", "--json"});
  EXPECT_EQ(json::parse(alone.output).at("formula"), answer.at("formula"));
}

TEST_F(FitTest, HasAsManyEvaluationsOfFormulasForManyRowsAsForFew) {
  std::string text = "x,y\n";
  for (int i = 0; i < 20'000; ++i) text += fmt::format("{},{}\n", i, 17 * i % 1001);
  write_text(folder_ / "long.csv", text);
  const ProgramRun run = run_tribench({"fit", (folder_ / "long.csv").string(), "--target", "y",
                                       "--inputs", "x", "--method", "random_search", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const json answer = json::parse(run.output);
  EXPECT_EQ(answer.at("ended"), "evaluations");
  EXPECT_GT(answer.at("evaluations").get<double>(), 3.9e9);
}

TEST_F(FitTest, SaysWhatItHadToBuildWithAndWhatItHadNot) {
  const std::vector<std::string> words = {"--target", "friction_torque_Nm", "--inputs",
                                          "velocity_rad_s", "--method"};
  const auto fit_by = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return fit(std::move(more)).output;
  };
  const std::string plain = fit_by({"random_search", "--evaluations", "100000"});
  EXPECT_THAT(plain, AllOf(HasSubstr("operators paper: + - * exp"), HasSubstr("--operators full")));
  const json wide = json::parse(
      fit_by({"random_search", "--evaluations", "100000", "--operators", "full", "--json"}));
  EXPECT_EQ(wide.at("operators"), "full");
  EXPECT_THAT(fit_by({"linear"}), Not(HasSubstr("operators"))) << "its form is fixed";
}

TEST_F(FitTest, IsTheSameForTheSameSeed) {
  const std::vector<std::string> words = {
      "--target",      "friction_torque_Nm", "--inputs", "velocity_rad_s", "--method",
      "random_search", "--evaluations",      "2000000",  "--seed",         "7"};
  const std::string first = fit(words).output;
  EXPECT_EQ(first.substr(0, first.rfind("node-rows")),
            fit(words).output.substr(0, first.rfind("node-rows")));
}

TEST_F(FitTest, RefusesBadInputWithPlaceAndMend) {
  const auto refused = [&](std::vector<std::string> words) {
    const ProgramRun run = fit(std::move(words));
    EXPECT_EQ(run.status, 2);
    return run.errors;
  };
  EXPECT_THAT(refused({"--target", "friction", "--inputs", "velocity_rad_s", "--method", "linear"}),
              HasSubstr("no column 'friction'"));
  EXPECT_THAT(refused({"--target", "friction_torque_Nm", "--inputs", "velocity_rad_s", "--method",
                       "linea"}),
              HasSubstr("did you mean linear?"));
  EXPECT_THAT(refused({"--target", "friction_torque_Nm", "--inputs", "velocity_rad_s", "--method",
                       "linear", "--operators", "papr"}),
              HasSubstr("did you mean paper?"));
  EXPECT_THAT(refused({"--target", "friction_torque_Nm", "--inputs", "velocity_rad_s", "--method",
                       "pysr", "--parameter", "template=f(velocity_rad)"}),
              HasSubstr("template, character 3: 'velocity_rad' is not an input; did you mean"));
  EXPECT_EQ(fit({"--target", "x", "--inputs", "y", "--method", "linear", "--seed", "-1"}).status,
            2);
  for (const std::string group : {"", "movement"}) {
    std::vector<std::string> words = {"--target", "friction_torque_Nm",
                                      "--inputs", "velocity_rad_s",
                                      "--method", "linear",
                                      "--test",   (folder_ / "train.csv").string()};
    if (!group.empty()) words.insert(words.end(), {"--group", group});
    EXPECT_THAT(refused(words), HasSubstr("train.csv' trains"));
  }
}

TEST_F(FitTest, AFileThatCannotBeWrittenIsFoundBeforeTheWork) {
  const std::filesystem::path begun = folder_ / "begun";
  const ProgramRun run =
      fit({"--target", "friction_torque_Nm", "--inputs", "velocity_rad_s", "--external",
           "touch " + begun.string(), "--save", (folder_ / "no folder/model.json").string()});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("name a file in a folder that is there"));
  EXPECT_FALSE(std::filesystem::exists(begun));
}

// y = 1.5 v + noise of 1 in every other row, none beside it: only weights tell which.
class UnequalRowsTest : public FitTest {
 protected:
  void SetUp() override {
    std::string text = "v,y,sigma,weight,group,fold,bad\n";
    for (int i = 0; i < 80; ++i) {
      const double v = -2 + 0.05 * i;
      const bool rough = i % 2 == 0;
      const double noise = rough ? 0.8 + std::sin(1.7 * i) : 1e-3 * std::sin(2.3 * i);
      text += std::to_string(v) + "," + std::to_string(1.5 * v + 0.25 + noise) + "," +
              (rough ? "1" : "0.001") + "," + (rough ? "0" : "1") + "," + std::to_string(i / 5) +
              "," + std::to_string(i % 4) + ",-1\n";
    }
    write_text(folder_ / "train.csv", text);
  }
  json answer(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"--target", "y", "--inputs", "v", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = fit(words);
    EXPECT_EQ(run.status, 0) << run.errors;
    return json::parse(run.output);
  }
  std::string refusal(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"--target", "y", "--inputs", "v"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = fit(words);
    EXPECT_EQ(run.status, 2) << run.errors;
    return run.errors;
  }
  // Whether a constant near 1.5 has an interval that holds 1.5 and is no wider than `width`.
  static bool knows_the_slope(const json& answer, double width) {
    for (const json& one : answer.at("intervals").at("constants")) {
      const double low = one.at("low");
      const double high = one.at("high");
      if (low <= 1.5 && 1.5 <= high && high - low <= width) return true;
    }
    return false;
  }
};

TEST_F(UnequalRowsTest, WeightsAndStandardDeviationsSayWhichRowsCount) {
  EXPECT_FALSE(knows_the_slope(answer({"--method", "linear"}), 0.01));
  EXPECT_TRUE(knows_the_slope(answer({"--method", "linear", "--sigma", "sigma"}), 0.01));
  EXPECT_TRUE(knows_the_slope(answer({"--method", "linear", "--weights", "weight"}), 0.01));
  for (const char* method : {"pysr", "udsr", "parfam", "relay"}) {
    EXPECT_TRUE(knows_the_slope(
        answer({"--method", method, "--evaluations", "30000000", "--sigma", "sigma"}), 0.01))
        << method;
  }
  EXPECT_THAT(refusal({"--method", "linear", "--weights", "bad"}),
              AllOf(HasSubstr("train.csv:2:bad: '-1'"), HasSubstr("0 or more")));
  EXPECT_THAT(refusal({"--method", "linear", "--sigma", "weight", "--where", "weight=0"}),
              AllOf(HasSubstr("train.csv:2:weight: '0'"), HasSubstr("above 0")));
  EXPECT_THAT(
      refusal({"--method", "linear", "--weights", "v"}),
      HasSubstr("--weights: 'v' is one of the --inputs too; give the column a second time"));
  EXPECT_THAT(refusal({"--method", "linear", "--sigma", "y"}),
              HasSubstr("--sigma: 'y' is the --target too"));
  EXPECT_THAT(refusal({"--method", "linear", "--weights", "weight", "--where", "weight=0"}),
              AllOf(HasSubstr("train.csv: 'weight' is 0 in all rows"), HasSubstr("a weight")));
  EXPECT_THAT(refusal({"--method", "linear", "--sigma", "sgima"}), HasSubstr("sigma"));
}

TEST_F(UnequalRowsTest, HoldsOutWhatItIsAskedTo) {
  const json whole = answer({"--method", "linear"});
  EXPECT_TRUE(whole.at("mae_test").is_null());
  EXPECT_EQ(whole.at("intervals").at("unit"), "row");
  EXPECT_EQ(whole.at("intervals").at("units"), 80);
  const json part = answer({"--method", "linear", "--split", "0.25", "--group", "group"});
  EXPECT_EQ(part.at("intervals").at("unit"), "movement");
  EXPECT_EQ(part.at("intervals").at("units"), 12);
  EXPECT_GT(part.at("mae_test").get<double>(), 0);
  EXPECT_EQ(answer({"--method", "linear", "--split", "fold=3"}).at("intervals").at("units"), 60);
  EXPECT_THAT(refusal({"--method", "linear", "--split", "fold=9"}), HasSubstr("values there"));
}

TEST_F(UnequalRowsTest, AFileMayHaveANameThatIsNotUtf8) {
  const std::filesystem::path latin = folder_ / "p\xe9riode.csv";
  write_text(latin, "x,y\n1,2\n2,4\n3,6\n4,8\n");
  const ProgramRun ended = run_tribench(
      {"fit", latin.string(), "--target", "y", "--inputs", "x", "--method", "linear", "--json"});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_EQ(json::parse(ended.output).at("formula"), "2*x");
}

TEST_F(UnequalRowsTest, AProgramIsAMethod) {
  write_text(folder_ / "mine.sh", "echo '{\"front\": [\"1.5*v + 0.25\"]}'\n");
  const json told = answer({"--external", "bash '" + (folder_ / "mine.sh").string() + "'"});
  EXPECT_EQ(told.at("formula"), "1.5*v + 0.25");
  EXPECT_EQ(told.at("ended"), "finished");
  EXPECT_THAT(refusal({"--external", "bash 'open"}), HasSubstr("--external"));
  // What would give the same again asks it for as much, and what it lacks is not a column's role.
  EXPECT_THAT(
      answer({"--external", "bash '" + (folder_ / "mine.sh").string() + "'", "--seconds", "5"})
          .at("reproduce")
          .get<std::string>(),
      AllOf(HasSubstr("--seconds 5"), Not(HasSubstr("--evaluations"))));
  write_text(folder_ / "none.sh", "echo '{\"unsupported\": \"no mylib; install it\"}'\n");
  EXPECT_THAT(refusal({"--external", "bash '" + (folder_ / "none.sh").string() + "'"}),
              AllOf(HasSubstr("no mylib; install it"), Not(HasSubstr("--roles"))));
}

// tau = a sgn(v) + b v + c v^3 in three machines, of sizes that differ a thousandfold.
class CategoryTest : public FitTest {
 protected:
  void SetUp() override {
    const double constants[3][3] = {{3, 2, -0.3}, {0.02, -0.005, 0.004}, {40, 10, 6}};
    std::string text = "v,machine,one,count,tau\n";
    for (int k = 0; k < 3; ++k) {
      const auto& [a, b, c] = constants[k];
      for (int i = 0; i < 60; ++i) {
        const double v = -1.97 + 0.0667 * i;
        const double exact = (v > 0 ? a : -a) + b * v + c * v * v * v;
        text +=
            fmt::format("{},{},1,{},{}\n", v, k + 4, i, exact + 1e-3 * a * std::sin(9.7 * i + k));
      }
    }
    write_text(folder_ / "train.csv", text);
  }
  std::vector<std::string> words(std::vector<std::string> more) {
    std::vector<std::string> all = {"--target", "tau",  "--inputs",      "v,sgn_v",
                                    "--method", "pysr", "--evaluations", "100000000"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(CategoryTest, OneShapeHasConstantsOfEachOnesOwn) {
  const ProgramRun run = fit(words({"--category", "machine", "--json"}));
  ASSERT_EQ(run.status, 0) << run.errors;
  const json answer = json::parse(run.output);
  EXPECT_THAT(answer.at("shape").get<std::string>(), HasSubstr("p1()"));
  const json& machines = answer.at("categories");
  ASSERT_EQ(machines.size(), 3U);
  const double sizes[] = {3, 0.02, 40};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(machines[k].at("category").get<double>(), static_cast<double>(k) + 4);
    EXPECT_LT(machines[k].at("mae_train").get<double>(), 1e-3 * sizes[k]);
    EXPECT_EQ(machines[k].at("constants").size(), machines[0].at("constants").size());
    EXPECT_FALSE(machines[k].at("own").at("formula").get<std::string>().empty());
  }
  EXPECT_NE(machines[0].at("constants"), machines[1].at("constants"));
  EXPECT_EQ(json::parse(fit(words({"--category", "machine", "--json"})).output).at("categories"),
            machines);
  // The same rows without it: no one formula is any good for all.
  const json together = json::parse(fit(words({"--json"})).output);
  EXPECT_GT(together.at("mae_train").get<double>(), 1);
}

class ManyCategoriesTest : public CategoryTest {
 protected:
  double seconds(int categories, const char* option, const std::string& value) {
    std::string text = "v,g,machine,tau\n";
    for (int k = 0; k < categories; ++k) {
      for (int i = 0; i < 10; ++i) {
        const double v = std::sin(2.7 * i + k);
        const double g = std::sin(1.9 * i + 0.3 * k);
        text +=
            fmt::format("{},{},{},{}\n", v, g, k,
                        (1 + k % 7) * v + 0.1 * (k % 11) + 0.5 * v * g + 0.01 * std::sin(99 * g));
      }
    }
    write_text(folder_ / "train.csv", text);
    const ProgramRun run = fit({"--target", "tau", "--inputs", "v,g", "--method", "pysr",
                                "--category", "machine", option, value, "--json"});
    EXPECT_EQ(run.status, 0) << run.errors;
    return json::parse(run.output).at("fit_cpu_s").get<double>();
  }
};

// With as many searches as categories, whose shapes were all fitted to every category, five times
// as many took fourteen times as long.
TEST_F(ManyCategoriesTest, TakeAsLongAsThereAreMany) {
  const double few = seconds(100, "--evaluations", std::to_string(400'000 * 100));
  EXPECT_LT(seconds(500, "--evaluations", std::to_string(400'000 * 500)), 9 * few);
}

// Each category's share of the seconds is none in which anything can be found, and was overspent.
TEST_F(ManyCategoriesTest, KeepToTheSeconds) { EXPECT_LT(seconds(1000, "--seconds", "1"), 3); }

TEST_F(CategoryTest, RefusesWhatIsNoColumnOfCategories) {
  const auto refusal = [&](std::vector<std::string> more) {
    const ProgramRun run = fit(words(std::move(more)));
    EXPECT_EQ(run.status, 2) << run.errors;
    return run.errors;
  };
  EXPECT_THAT(refusal({"--category", "one"}), HasSubstr("one value"));
  EXPECT_THAT(refusal({"--category", "count"}),
              AllOf(HasSubstr("3 training rows"), HasSubstr("10")));
  EXPECT_THAT(refusal({"--category", "machin"}), HasSubstr("machine"));
  EXPECT_THAT(refusal({"--category", "machine", "--weights", "one"}), HasSubstr("--category"));
}

TEST_F(UnequalRowsTest, ASavedModelPredictsWithIntervals) {
  const std::string model = (folder_ / "model.json").string();
  answer({"--method", "linear", "--save", model});
  const ProgramRun run =
      run_tribench({"predict", model, (folder_ / "train.csv").string(), "--intervals"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, ::testing::StartsWith("prediction,low,high\n"));
  EXPECT_EQ(std::ranges::count(run.output, '\n'), 81);
  const ProgramRun none =
      run_tribench({"predict", "2*v", (folder_ / "train.csv").string(), "--intervals"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("--save"));
}

TEST_F(UnequalRowsTest, AModelReadsLaterDataAsItsOwn) {
  std::string text = "w,tau,spare\n";
  for (int i = -50; i <= 50; ++i) {
    text += fmt::format("{},{:.17g},{}\n", 2 * i, 0.5 + 3 * (2 * i * std::numbers::pi / 180),
                        i == 7 ? "" : "1");
  }
  write_text(folder_ / "turns.csv", text);
  const std::string data = (folder_ / "turns.csv").string();
  const std::string model = (folder_ / "turns.json").string();
  ASSERT_EQ(run_tribench({"fit", data, "--target", "tau", "--inputs", "w", "--roles",
                          "w=velocity[deg/s]", "--method", "linear", "--save", model})
                .status,
            0);
  const auto first = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"predict", model, data};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = run_tribench(words);
    EXPECT_EQ(run.status, 0) << run.errors;
    EXPECT_EQ(std::ranges::count(run.output, '\n'), 102);
    return std::stod(run.output.substr(run.output.find('\n') + 1));
  };
  EXPECT_NEAR(first({}), 0.5 - 3 * 100 * std::numbers::pi / 180, 1e-6);
  // Unless other data are said to be something else.
  EXPECT_NEAR(first({"--roles", "w=velocity[rad/s]"}), 0.5 - 3 * 100, 1e-4);
}

TEST_F(UnequalRowsTest, TheCommandItNamesGivesTheSameAgain) {
  // Of seconds it says the evaluations that they came to.
  const json clocked = answer({"--method", "pysr", "--seconds", "0.05"});
  EXPECT_THAT(clocked.at("reproduce").get<std::string>(),
              HasSubstr("--evaluations " + clocked.at("evaluations").dump()));
  const std::string joined =
      answer({"--method", "pysr", "--seconds=0.05"}).at("reproduce").get<std::string>();
  EXPECT_THAT(joined, Not(HasSubstr("0.05")));
  EXPECT_FALSE(clocked.at("reproduces_exactly"));
  // Seconds that were not needed change nothing: the same command again.
  const json timed = answer({"--method", "linear", "--seconds", "20"});
  EXPECT_TRUE(timed.at("reproduces_exactly"));
  EXPECT_THAT(timed.at("reproduce").get<std::string>(),
              AllOf(HasSubstr("--seconds 20"), Not(HasSubstr("--evaluations"))));
  const json once = answer({"--method", "pysr", "--seed", "7"});
  const std::string line = once.at("reproduce");
  const ProgramRun again = run_to_end(
      {"bash", "-c", "'" + program().string() + "'" + line.substr(std::string("tribench").size())});
  ASSERT_EQ(again.status, 0) << again.errors;
  EXPECT_EQ(json::parse(again.output).at("formula"), once.at("formula"));
}

TEST_F(UnequalRowsTest, AFileOfAnotherNameGivesTheSameAnswer) {
  const auto formula_of = [&](const char* file, const std::vector<std::string>& more) {
    std::vector<std::string> words = {
        "fit",  (folder_ / file).string(), "--target", "y",     "--inputs", "v", "--method",
        "pysr", "--evaluations",           "300000",   "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = run_tribench(words);
    EXPECT_EQ(run.status, 0) << run.errors;
    const json answer = json::parse(run.output);
    return answer.at("formula").dump() + answer.at("mae_test").dump() +
           answer.at("evaluations").dump();
  };
  std::filesystem::copy_file(folder_ / "train.csv", folder_ / "Monday's run.csv");
  EXPECT_EQ(formula_of("train.csv", {}), formula_of("Monday's run.csv", {}));
  EXPECT_EQ(formula_of("train.csv", {"--split", "0.25"}),
            formula_of("Monday's run.csv", {"--split", "0.25"}));
}

// Minutes of search were lost with it.
TEST_F(FitTest, CtrlCEndsTheSearchAndGivesWhatItHasFound) {
  std::string noisy = "x,z,y\n";
  for (int i = 0; i < 300; ++i) {
    const double x = 0.05 * i;
    const double z = std::fmod(0.37 * i, 2.0);
    noisy += fmt::format("{},{},{}\n", x, z, std::sin(x * x) / (1 + z) + std::fmod(7.13 * i, 1.0));
  }
  write_text(folder_ / "noisy.csv", noisy);
  const ProgramRun run = run_to_end({"timeout", "--preserve-status", "--signal=INT", "2",
                                     program().string(), "fit", (folder_ / "noisy.csv").string(),
                                     "--target", "y", "--inputs", "x,z", "--seconds", "600"});
  EXPECT_EQ(run.status, 4) << run.errors;
  EXPECT_THAT(run.output, AllOf(HasSubstr("ended by: stopped"), HasSubstr("complexity")));
}

}  // namespace
}  // namespace tribench::testing
