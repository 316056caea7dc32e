// SPDX-License-Identifier: MIT
//
// What the paper tries fitted friction models on, beside the error tables: estimating the external
// torque in dataset B with load, and following a sinusoidal velocity.
#pragma once

#include <cstdint>
#include <vector>

#include "problems/kuka/joint.hpp"
#include "problems/problem.hpp"

namespace tribench::kuka {

// The estimator knows the arm but not the payload: its g is the arm's own gravity torque, and what
// it makes of the motor torque is
//   tau_ext = (tau_m - g_arm) - f(qd, sgn_qd, g_arm, sgn_g_arm).
struct ExternalTorqueTrial {
  // Columns qd, sgn_qd, g, sgn_g; target tau_m - g_arm; truth tau_ext. All in N m.
  Table rows;
  // Per row: |g_arm| beyond the largest that the adaptation's movement has seen, where the adapted
  // part of a formula extrapolates.
  std::vector<char> outside_fitted_range;
  double largest_fitted_gravity_nm = 0;
};

// The rows are those of the test of B/jN/load with the same seed.
ExternalTorqueTrial make_external_torque_trial(const Joint& joint, std::uint64_t seed);

// qd = 0.6 sin(2 pi t / 10 s) for one period, q = -0.955 cos(2 pi t / 10 s), with A's gravity
// torque; one row each 10 ms, noise-free: target and truth are A's law. Columns as for A with
// load; times in s.
struct VelocityProfile {
  std::vector<double> time_s;
  Table rows;
};
VelocityProfile make_velocity_profile(const Joint& joint);

}  // namespace tribench::kuka
