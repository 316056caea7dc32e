// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

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
    std::vector<std::string> command = {program().string(), "fit",
                                        (folder_ / "train.csv").string()};
    command.insert(command.end(), more.begin(), more.end());
    return run_to_end(command);
  }
  TemporaryFolder folder_;
};

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
}

}  // namespace
}  // namespace tribench::testing
