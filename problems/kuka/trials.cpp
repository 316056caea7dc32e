// SPDX-License-Identifier: MIT
#include "problems/kuka/trials.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/sign.hpp"
#include "problems/kuka/entries.hpp"

namespace tribench::kuka {
namespace {

constexpr double kPeak_rad_s = 0.6;
constexpr double kPeriod_s = 10;
constexpr int kProfileRows = 1001;

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

ExternalTorqueTrial make_external_torque_trial(const Joint& joint, std::uint64_t seed) {
  ExternalTorqueTrial trial;
  trial.largest_fitted_gravity_nm =
      largest_magnitude(make_adaptation_movement(joint, seed).data.at("g").values);
  const Dataset data = make_b_test(joint, seed, true).data;
  const std::vector<double>& velocity = data.at("qd").values;
  const std::vector<double>& arm = data.at("g_arm").values;
  const std::vector<double>& motor = data.at("tau_m").values;
  trial.rows.columns.resize(4);
  for (std::size_t r = 0; r < data.rows(); ++r) {
    trial.rows.columns[0].push_back(velocity[r]);
    trial.rows.columns[1].push_back(sign(velocity[r]));
    trial.rows.columns[2].push_back(arm[r]);
    trial.rows.columns[3].push_back(sign(arm[r]));
    trial.rows.target.push_back(motor[r] - arm[r]);
    trial.outside_fitted_range.push_back(std::abs(arm[r]) > trial.largest_fitted_gravity_nm ? 1
                                                                                            : 0);
  }
  trial.rows.truth = data.at("tau_ext").values;
  trial.rows.movement = data.movement;
  return trial;
}

VelocityProfile make_velocity_profile(const Joint& joint) {
  VelocityProfile profile;
  profile.rows.columns.resize(4);
  const double rate = 2 * kPi / kPeriod_s;
  for (int k = 0; k < kProfileRows; ++k) {
    const double time = kPeriod_s * k / (kProfileRows - 1);
    const double velocity = kPeak_rad_s * elementary::sin(rate * time);
    const double position = -kPeak_rad_s / rate * elementary::cos(rate * time);
    const double gravity = joint.gravity_amplitude_nm * elementary::sin(position);
    const double friction = joint.law.at(velocity, gravity);
    profile.time_s.push_back(time);
    profile.rows.columns[0].push_back(velocity);
    profile.rows.columns[1].push_back(sign(velocity));
    profile.rows.columns[2].push_back(gravity);
    profile.rows.columns[3].push_back(sign(gravity));
    profile.rows.target.push_back(friction);
    profile.rows.truth.push_back(friction);
    profile.rows.movement.push_back(0);
  }
  return profile;
}

}  // namespace tribench::kuka
