// SPDX-License-Identifier: MIT
//
// What the robot does in the campaigns that the closed loop is tried on: constant-velocity
// movements (A) and two-tone trajectories with reversals (D), in random order, with all channels
// but the friction.
//
// A: `constant_velocity` movements over the whole stroke, speeds uniform in both directions, 40
// instants each, the first at the start. D: `trajectories` of 12 s, 120 instants each, peak below
// 0.68 rad/s; the other joint moves in 60 % of them. Every movement is done in one of two postures
// (gravity amplitude and phase). The joint warms up from 24 towards 40 degC and cools down in a
// pause half way, so that temperature and time can be told apart.
//
// Source: the specification of the closed loop, section 8.4.
#pragma once

#include <vector>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"

namespace tribench::kuka {

inline constexpr double kCoolest_degc = 24;
inline constexpr double kWarmest_degc = 40;

struct LoopCampaign {
  // time_s, position_rad, velocity_rad_s, acceleration_rad_s2, gravity_torque_Nm,
  // temperature_degC, other_velocity_rad_s, other_acceleration_rad_s2
  Dataset data;
  // What no channel says directly, per row.
  std::vector<double> distance_rad;   // since the last reversal or the movement's start
  std::vector<double> campaign_part;  // time as a part of the whole campaign, 0 to 1
};

// constant_velocity is even and >= 2, trajectories >= 0.
LoopCampaign make_loop_campaign(int constant_velocity, int trajectories,
                                const RandomStream& random);

}  // namespace tribench::kuka
