// SPDX-License-Identifier: MIT
#include "algorithms/loop_model/signal_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "problems/data_problem.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/reading/csv.hpp"

namespace tribench::loop {
namespace {

TEST(Observations, FrictionAgainstTheVelocityIsRefusedWithTheMend) {
  PlantedData planted = kuka::make_planted({}, 1);
  for (Channel& channel : planted.data.channels) {
    if (channel.role != Role::friction_torque) continue;
    for (double& y : channel.values) y = -y;
  }
  try {
    observe(planted.data);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.mend()).find("--flip-sign"), std::string::npos);
  }
  flip_torques(planted.data);
  EXPECT_NO_THROW(observe(planted.data));
}

TEST(Observations, FrictionThatWasTurnedAgainstTheVelocityIsNotToBeTurned) {
  PlantedData planted = kuka::make_planted({}, 1);
  flip_torques(planted.data);
  try {
    observe(planted.data);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.mend()).find("leave --flip-sign out"), std::string::npos);
  }
}

TEST(Observations, AFewRowsTheOtherWayAreLeftOutAndSaid) {
  PlantedData planted = kuka::make_planted({.trajectories = 0}, 1);
  const auto values = [&](Role role) -> std::vector<double>& {
    return std::ranges::find(planted.data.channels, role, &Channel::role)->values;
  };
  std::vector<double>& v = values(Role::velocity);
  std::vector<double>& y = values(Role::friction_torque);
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (i % 1000 == 0) continue;
    v[i] = std::abs(v[i]);
    y[i] = std::abs(y[i]);
  }
  const Observations data = observe(planted.data);
  EXPECT_GT(data.rows(), v.size() - 10);
  const std::vector<double>& kept = data.find("v")->values;
  EXPECT_TRUE(std::ranges::all_of(kept, [](double x) { return x > 0; }));
  EXPECT_TRUE(std::ranges::any_of(data.warnings, [](const std::string& warning) {
    return warning.find("one direction") != std::string::npos;
  }));
}

TEST(Observations, DistanceSinceReversalIsKnownOnlyWhereSomethingTurnsOrStartsFromStandstill) {
  const auto observed = [](double first) {
    std::string text = "movement,time_s,v,friction_torque_Nm\n";
    for (int m = 0; m < 4; ++m) {
      for (int i = 0; i < 50; ++i) {
        const double v = (m % 2 == 0 ? 1 : -1) * (i == 0 ? first : 1.0 + 0.01 * i);
        text += std::to_string(m) + "," + std::to_string(0.1 * i) + "," + std::to_string(v) + "," +
                std::to_string(v) + "\n";
      }
    }
    return observe(parse_csv(text, "d.csv").data);
  };
  EXPECT_EQ(observed(1.0).find("d"), nullptr);
  const Observations data = observed(0.0);
  ASSERT_NE(data.find("d"), nullptr);
  EXPECT_GT(data.find("d")->values[49], 4.0);
}

// What was before the recording began is not seen: as far back as any reversal that is.
TEST(Observations, AMovementThatStartsInMotionHasTurnedBeforeTheRecordingBegan) {
  std::string text = "movement,time_s,v,friction_torque_Nm\n";
  for (int m = 0; m < 2; ++m) {
    for (int i = 0; i < 50; ++i) {
      const double v = m == 0 ? std::cos(0.1 * i) : std::sin(0.1 * i);
      text += std::to_string(m) + "," + std::to_string(0.1 * i) + "," + std::to_string(v) + "," +
              std::to_string(v) + "\n";
    }
  }
  const Observations data = observe(parse_csv(text, "d.csv").data);
  ASSERT_NE(data.find("d_seen"), nullptr);
  const std::vector<double>& d = data.find("d")->values;
  const std::vector<double>& seen = data.find("d_seen")->values;
  const double farthest = *std::ranges::max_element(d);
  std::size_t before_the_turn = 0;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const bool unseen = data.movement[i] == 0 && data.time[i] < 1.55;
    before_the_turn += unseen ? 1 : 0;
    EXPECT_EQ(seen[i], unseen ? farthest : d[i]) << i;
  }
  EXPECT_EQ(before_the_turn, 16U);
}

// A column may be named as effects name it.
TEST(Observations, ColumnsNamedLikeSignalsAreTheirSignals) {
  std::string text = "movement,v,g,q,tau_f\n";
  for (int i = 0; i < 80; ++i) {
    const double v = i < 40 ? 1 + 0.01 * i : -1 - 0.01 * i;
    text += "1," + std::to_string(v) + "," + std::to_string(0.1 * i) + "," + std::to_string(i) +
            "," + std::to_string(3 * v) + "\n";
  }
  const Observations data = observe(parse_csv(text, "d.csv").data);
  for (const char* name : {"v", "g", "q", "sgn_v", "sgn_g"}) {
    EXPECT_NE(data.find(name), nullptr) << name;
  }
}

TEST(Observations, RowsThatAreNotFiniteAreDroppedAndCounted) {
  PlantedData planted = kuka::make_planted({}, 1);
  planted.data.channels[1].values[7] = std::numeric_limits<double>::quiet_NaN();
  const Observations data = observe(planted.data);
  EXPECT_EQ(data.rows(), planted.data.rows() - 1);
  ASSERT_FALSE(data.warnings.empty());
  EXPECT_NE(data.warnings[0].find("1 rows"), std::string::npos);
}

}  // namespace
}  // namespace tribench::loop
