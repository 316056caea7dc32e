// SPDX-License-Identifier: MIT
//
// Declared gravity beside the torque that holds it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "problems/preparation/recording.hpp"
#include "problems/preparation/rigid_body.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

// What is said of a swinging joint whose torque holds `held` times the gravity that is declared.
std::string complaint_where_torque_holds(double held) {
  std::string text = "t,q,dq,tau,g\n";
  for (int i = 0; i < 5000; ++i) {
    const double t = 0.004 * i;
    const double q = std::sin(1.3 * t) + 0.5 * std::sin(0.31 * t);
    const double v = 1.3 * std::cos(1.3 * t) + 0.155 * std::cos(0.31 * t);
    const double gravity = 10 * std::cos(q);
    const double friction = (v > 0 ? 1 : -1) + 0.5 * v + 0.02 * std::sin(17.0 * i);
    text += fmt::format("{:.4f},{:.7f},{:.6f},{:.5f},{:.5f}\n", t, q, v, held * gravity + friction,
                        gravity);
  }
  DataOptions options;
  CsvOptions csv;
  csv.used.emplace();
  csv.roles = parse_roles(
      "t=time[s],q=position[rad],dq=velocity[rad/s],tau=motor_torque[N m],g=gravity_torque[N m]",
      "--roles");
  try {
    prepare(parse_csv(text, "log.csv", csv), options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A model of gravity is off by some tenths, and a payload adds to it; neither turns its sign.
TEST(RecordingGravity, ATurnedSignIsRefusedHoweverGoodTheModel) {
  for (const double held : {0.7, 1.0, 1.6}) {
    EXPECT_EQ(complaint_where_torque_holds(held), "no error") << held;
    EXPECT_THAT(complaint_where_torque_holds(-held), HasSubstr("has its sign turned")) << held;
  }
}

// A joint that stands still most of the time, its brake on: noise is all of its velocity there, and
// the torque is no friction. `held`: of the gravity that is declared.
Dataset mostly_resting(double gravity_at_most, double held) {
  constexpr double kStep = 0.02;
  constexpr int kResting = 60000;
  constexpr int kRows = 62000;
  RandomStream random(17);
  Dataset data;
  data.movement.assign(kRows, 0);
  data.movement_names = {"log"};
  Channel velocity{"dq", "rad/s", Role::velocity, {}};
  Channel torque{"tau", "N m", Role::motor_torque, {}};
  Channel load{"g", "N m", Role::gravity_torque, {}};
  double q = 0;
  for (int i = 0; i < kRows; ++i) {
    const double t = kStep * (i - kResting);
    const bool rests = i < kResting;
    const double v = rests ? 0 : 0.9 * std::sin(0.9 * t);
    q += kStep * v;
    const double gravity = gravity_at_most * std::sin(q + 0.3);
    const double friction = rests ? 3 : (v > 0 ? 2 : -2) + 0.8 * v - 0.1 * v * std::abs(v);
    velocity.values.push_back(v + 0.02 * random.normal());
    torque.values.push_back(held * gravity + friction + 0.05 * random.normal());
    load.values.push_back(gravity);
  }
  data.channels = {velocity, torque, load};
  return data;
}

TEST(RecordingGravity, RowsThatStandStillTellNoFactor) {
  const auto told = [](double gravity_at_most, double held) -> std::optional<double> {
    const std::optional<GravityFactor> factor =
        gravity_factor(mostly_resting(gravity_at_most, held));
    if (!factor || std::abs(factor->value) < 10 * factor->error) return {};
    return factor->value;
  };
  EXPECT_FALSE(told(0.0007, 1)) << "next to nothing";
  ASSERT_TRUE(told(20, 1));
  EXPECT_NEAR(*told(20, 1), 1, 0.02);
  ASSERT_TRUE(told(0.02, 1000)) << "in N mm";
  EXPECT_NEAR(*told(0.02, 1000), 1000, 20);
}

}  // namespace
}  // namespace tribench
