// SPDX-License-Identifier: MIT
#include "problems/data_problem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <fstream>

#include "foundation/error.hpp"
#include "problems/preparation/data_options.hpp"
#include "problems/reading/csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

Dataset small() {
  return parse_csv("velocity_rad_s,tau_g,tau_f,y\n-1,2,-5,1\n0,3,0,2\n2,-4,6,3\n", "small.csv")
      .data;
}

std::string complaint(const Dataset& data, const std::string& target,
                      const std::vector<std::string>& inputs) {
  try {
    make_data_problem(data, nullptr, target, inputs);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(DataProblem, TakesTheColumnsAskedForAndDerivesSigns) {
  const Dataset data = small();
  const std::vector<std::string> inputs = {"velocity_rad_s", "sgn_velocity_rad_s"};
  const Problem problem = make_data_problem(data, &data, "tau_f", inputs);
  EXPECT_EQ(problem.input_names(), inputs);
  EXPECT_EQ(problem.inputs[1].sign_of, std::optional<std::size_t>(0));
  EXPECT_EQ(problem.inputs[0].low, -1);
  EXPECT_EQ(problem.inputs[0].high, 2);
  EXPECT_EQ(problem.target_unit, "N m");
  EXPECT_EQ(problem.stages.front().train.columns[1], (std::vector<double>{-1, 0, 1}));
  EXPECT_EQ(problem.test.target, (std::vector<double>{-5, 0, 6}));
  EXPECT_EQ(make_data_problem(data, nullptr, "tau_f", inputs).test.rows(), 0U);
}

Dataset wide(std::size_t columns) {
  Dataset data;
  data.name = "wide";
  data.movement = {0, 0};
  data.movement_names = {"wide"};
  for (std::size_t j = 0; j < columns; ++j) {
    data.channels.push_back({fmt::format("x{}", j), "-", Role::none, {0.5, 1}});
  }
  return data;
}

// Columns are found by name: to look at each for each would take minutes of 65 000.
TEST(DataProblem, TakesTimeInProportionToItsColumns) {
  const Dataset data = wide(30'000);
  std::vector<std::string> inputs;
  for (const Channel& channel : data.channels) inputs.push_back(channel.name);
  inputs.erase(inputs.begin());
  const std::clock_t start = std::clock();
  EXPECT_EQ(make_data_problem(data, nullptr, "x0", inputs).inputs.size(), 29'999U);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 2);
}

TEST(DataProblem, RefusesMoreInputsThanAFormulaCanName) {
  const Dataset data = wide(kMostInputs + 2);
  std::vector<std::string> inputs;
  for (const Channel& channel : data.channels) inputs.push_back(channel.name);
  inputs.erase(inputs.begin());
  EXPECT_THAT(complaint(data, "x0", inputs), HasSubstr("65537 inputs are given"));
}

TEST(DataProblem, TheBoxCoversTheRowsThatTest) {
  const Dataset data = small();
  Dataset other = data;
  for (double& v : other.channels[0].values) v *= 3;
  ASSERT_EQ(other.channels[0].name, "velocity_rad_s");
  const std::vector<std::string> inputs = {"velocity_rad_s"};
  const Problem problem = make_data_problem(data, &other, "tau_f", inputs);
  EXPECT_EQ(problem.inputs[0].low, -3);
  EXPECT_EQ(problem.inputs[0].high, 6);
}

TEST(DataProblem, RefusesFrictionThatOpposesVelocityUntilItIsFlipped) {
  Dataset data = small();
  flip_torques(data);
  EXPECT_THAT(complaint(data, "tau_f", {"velocity_rad_s"}), HasSubstr("--flip-sign"));
  // Another column has no such convention.
  EXPECT_EQ(complaint(data, "y", {"velocity_rad_s"}), "no error");
  flip_torques(data);
  EXPECT_EQ(complaint(data, "tau_f", {"velocity_rad_s"}), "no error");
  EXPECT_EQ(data.at("tau_g").values, small().at("tau_g").values);
}

TEST(DataProblem, WhereTheTorquesWereTurnedToOpposeTheMendIsNotToTurnThem) {
  Dataset data = small();
  flip_torques(data);
  EXPECT_THAT(complaint(data, "tau_f", {"velocity_rad_s"}), HasSubstr("leave --flip-sign out"));
}

TEST(DataProblem, FrictionThatFallsWithSpeedInOneDirectionDoesNotOpposeIt) {
  const Dataset data = parse_csv("velocity_rad_s,tau_f\n1,9\n2,8\n3,7\n", "one.csv").data;
  EXPECT_EQ(complaint(data, "tau_f", {"velocity_rad_s"}), "no error");
  const Dataset wrong = parse_csv("velocity_rad_s,tau_f\n1,-7\n2,-8\n3,-6\n", "one.csv").data;
  EXPECT_THAT(complaint(wrong, "tau_f", {"velocity_rad_s"}), HasSubstr("opposes"));
}

TEST(DataProblem, ComplainsOfColumnsByName) {
  EXPECT_THAT(complaint(small(), "tau_x", {"y"}), HasSubstr("did you mean tau_"));
  EXPECT_THAT(complaint(small(), "tau_f", {"velocity_rads"}), HasSubstr("velocity_rad_s"));
  EXPECT_THAT(complaint(small(), "tau_f", {"tau_f"}), HasSubstr("target and an input"));
  EXPECT_THAT(complaint(small(), "tau_f", {"y", "y"}), HasSubstr("twice"));
  EXPECT_THAT(complaint(small(), "tau_f", {}), HasSubstr("no input"));
}

// For a fit a column is what the user says it is. Whatever columns are called, and in whatever
// units, any explains any other; what lies in the columns that are not used means nothing.
TEST(DataProblem, TakesEveryPairOfColumnsWhateverTheyAreCalled) {
  const std::vector<std::string> names = {
      "t",       "time",        "time_s",       "stamp",   "movement",   "run",
      "q",       "position",    "pos_deg",      "v",       "qd",         "velocity_rad_s",
      "vel_rpm", "qdd",         "acceleration", "tau",     "tau_m",      "tau_g",
      "tau_f",   "effort",      "torque_mNm",   "force_N", "g",          "gravity_torque_Nm",
      "T",       "temperature", "temp_degC",    "i",       "current_mA", "voltage_V",
      "load",    "payload_kg",  "sgn_v"};
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  text += "\n";
  for (int row = 0; row < 4; ++row) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      // Time that runs back, friction against the velocity, positions that are no velocity's.
      const int value = (7 * row + 3 * static_cast<int>(j)) % 5 - 2;
      text += (j == 0 ? "" : ",") + std::to_string(value);
    }
    text += "\n";
  }
  const std::filesystem::path file = testing::scratch_folder() / "innocent.csv";
  std::ofstream(file) << text;
  int pairs = 0;
  for (const std::string& target : names) {
    for (const std::string& input : names) {
      if (input == target) continue;
      ++pairs;
      EXPECT_NO_THROW({
        const std::vector<std::filesystem::path> files = {file};
        const DataFile read =
            read_named_columns(files, {}, std::vector<std::string>{target, input});
        make_data_problem(read.data, nullptr, target, std::vector<std::string>{input});
      }) << target
         << " from " << input;
    }
  }
  EXPECT_EQ(pairs, 1056);
}

}  // namespace
}  // namespace tribench
