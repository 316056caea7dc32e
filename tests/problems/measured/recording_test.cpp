// SPDX-License-Identifier: MIT
#include "problems/measured/recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "foundation/error.hpp"
#include "tests/support/paths.hpp"

namespace tribench::measured {
namespace {

class Recording : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::scratch_folder() /
              ("tribench_recording_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file(const std::string& text) const {
    const auto path = folder_ / "run.csv";
    std::ofstream(path) << text;
    return path;
  }

  std::filesystem::path folder_;
};

TEST_F(Recording, KeepsRowsDerivesChannelsAndGivesRoles) {
  ProblemPlan plan;
  plan.columns["load"] = {Role::gravity_torque, "A"};
  plan.keep_column = "on";
  plan.keep_value = 1;
  plan.derived = {
      {"friction", DerivedChannel::Kind::difference, {"i", "load"}, 1, Role::friction_torque, "A"},
      {"direction", DerivedChannel::Kind::sign, {"v"}, 1, Role::velocity_sign, "-"},
      {"twice", DerivedChannel::Kind::scaled, {"friction"}, 2, Role::none, "A"}};
  const Dataset data =
      read_recording(plan, file("v,i,load,on\n1,5,2,1\n1,9,9,0\n-1,-4,1,1\n0,1,1,1\n"));
  EXPECT_EQ(data.at("friction").values, (std::vector<double>{3, -5, 0}));
  EXPECT_EQ(data.at("direction").values, (std::vector<double>{1, -1, 0}));
  EXPECT_EQ(data.at("twice").values, (std::vector<double>{6, -10, 0}));
  EXPECT_EQ(data.at("load").role, Role::gravity_torque);
  EXPECT_EQ(data.at("load").unit, "A");
}

TEST_F(Recording, CutsMovementsAtReversalsButNotAtStandstillNoise) {
  ProblemPlan plan;
  plan.movements.kind = MovementRule::Kind::reversals;
  const Dataset data = read_recording(
      plan, file("v,y\n0.001,1\n-0.001,1\n1,1\n0.001,1\n-0.001,1\n1,1\n-1,1\n-0.5,1\n0,1\n2,1\n"));
  EXPECT_EQ(data.movement, (std::vector<int>{0, 0, 0, 0, 0, 0, 1, 1, 1, 2}));
  EXPECT_EQ(data.movement_names.size(), 3U);
}

TEST_F(Recording, CutsByColumnIntoPiecesAndAverages) {
  ProblemPlan plan;
  plan.movements = {MovementRule::Kind::column, "run", 2};
  plan.average = true;
  const Dataset data = read_recording(plan, file("run,v\na,1\na,2\na,3\na,4\nb,10\nb,20\n"));
  EXPECT_EQ(data.movement_names, (std::vector<std::string>{"a 1/2", "a 2/2", "b 1/2", "b 2/2"}));
  EXPECT_EQ(data.at("v").values, (std::vector<double>{1.5, 3.5, 10, 20}));
}

TEST_F(Recording, DecimatesChannelsMovementsAndTimeAlike) {
  std::string text = "time_s,v,y\n";
  for (int i = 0; i < 400; ++i) {
    text += std::to_string(i) + "," + (i < 200 ? "1" : "-1") + ",7\n";
  }
  ProblemPlan plan;
  plan.movements.kind = MovementRule::Kind::reversals;
  plan.decimate = 4;
  const Dataset data = read_recording(plan, file(text));
  ASSERT_EQ(data.rows(), 100U);
  EXPECT_EQ(data.at("time_s").values[30], 120);
  EXPECT_NEAR(data.at("y").values[50], 7, 1e-9);
  EXPECT_EQ(data.movement[49], 0);
  EXPECT_EQ(data.movement[50], 1);
}

TEST_F(Recording, AMissingColumnIsNamed) {
  ProblemPlan plan;
  plan.derived = {{"d", DerivedChannel::Kind::sign, {"vv"}, 1, Role::none, "-"}};
  EXPECT_THROW(read_recording(plan, file("v,y\n1,2\n")), Error);
}

}  // namespace
}  // namespace tribench::measured
