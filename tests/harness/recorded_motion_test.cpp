// SPDX-License-Identifier: MIT
#include "harness/exploration/recorded_motion.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace tribench {
namespace {

using ::testing::HasSubstr;

MotionLimits usual_limits() {
  MotionLimits limits;
  limits.lowest_rad = -1.5;
  limits.highest_rad = 1.5;
  limits.speed_rad_s = 2;
  limits.acceleration_rad_s2 = 7;
  limits.rate_hz = 12.5;
  return limits;
}

// One tone of the planned two that swells from standstill in 0.4 s, as a robot starts it.
Dataset swelling(const PlannedMovement& asked, double rate_hz, double velocity_unit) {
  Dataset rows;
  rows.channels = {{"time_s", "s", Role::time, {}},
                   {"position_rad", "rad", Role::position, {}},
                   {"velocity_rad_s", "rad/s", Role::velocity, {}}};
  const double centre = 0.5 * (asked.from + asked.to);
  const double rate = 2 * std::numbers::pi * asked.tones[0].frequency;
  const auto at = [&](double t_s) {
    return centre + std::min(1.0, t_s / 0.4) * asked.tones[0].amplitude * std::sin(rate * t_s);
  };
  for (double t_s = 0; t_s <= asked.duration; t_s += 1 / rate_hz) {
    rows.channels[0].values.push_back(t_s);
    rows.channels[1].values.push_back(at(t_s));
    rows.channels[2].values.push_back(velocity_unit * (at(t_s + 1e-5) - at(t_s)) / 1e-5);
    rows.movement.push_back(0);
  }
  return rows;
}

TEST(RecordedMotion, AShortOneThatStartsGentlyIsNoOther) {
  const MotionLimits limits = usual_limits();
  PlannedMovement asked = two_tone_movement(limits.speed_rad_s, -0.1, 0.1, 1);
  asked.duration = 0.35;
  EXPECT_EQ(misfit_of(swelling(asked, limits.rate_hz, 1), asked, limits).what, "");
  asked.duration = 2;
  EXPECT_EQ(misfit_of(swelling(asked, 50, 1), asked, limits).what, "");
  EXPECT_THAT(misfit_of(swelling(asked, 50, 9.549297), asked, limits).what,
              HasSubstr("where the velocity says"));
}

TEST(RecordedMotion, ATorqueFarOverTheLimitIsInAnotherUnit) {
  MotionLimits limits = usual_limits();
  limits.torque_nm = 60;
  PlannedMovement asked = two_tone_movement(limits.speed_rad_s, -0.1, 0.1, 1);
  asked.duration = 2;
  const auto with_torque = [&](double torque) {
    Dataset rows = swelling(asked, 50, 1);
    rows.channels.push_back(
        {"motor_torque_Nm", "N m", Role::motor_torque, std::vector(rows.rows(), torque)});
    return misfit_of(rows, asked, limits).what;
  };
  EXPECT_EQ(with_torque(-65), "");
  EXPECT_THAT(with_torque(-6500), HasSubstr("torque reaches 6500 N m, and the limit is 60"));
}

}  // namespace
}  // namespace tribench
