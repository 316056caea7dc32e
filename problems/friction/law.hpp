// SPDX-License-Identifier: MIT
//
// The friction of one joint, positive with velocity, as a law with known parameters: what the
// generated datasets obey and what a method should find. Not a model to be fitted; those live with
// the algorithms.
//
//   f(v, g) = s [F0 + F1 |v| - F4 |v|^4 + c0 (|g| - gbar)] + c1 g + c2 tanh(g / g0)     s = sgn(v)
//
// with F0, F1, F4 of the direction of motion. c0 is Coulomb friction that grows with the load, c1
// and c2 are its dependence on the power quadrant (whether the load drives or resists). At v = 0
// the bracket is 0.
//
// Source: the specification of the closed loop, section 8.2; joint 2's F are a least-squares fit to
// the mean of the three formulas that Scholl et al. 2025 print in Table 1, joint 4's are chosen to
// give the printed errors.
#pragma once

#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace tribench {

inline constexpr double kPi = std::numbers::pi;

// One direction of motion; velocity in rad/s, torque in N m.
struct Branch {
  double coulomb_nm = 0;    // F0
  double viscous = 0;       // F1 [N m s/rad]
  double quartic_loss = 0;  // F4 [N m s^4/rad^4]

  double at(double speed_rad_s) const;
};

struct FrictionLaw {
  Branch positive;
  Branch negative;
  double load_coulomb = 0;         // c0, N m a N m of load
  double mean_load_nm = 0;         // gbar: the averaged curve keeps F0
  double quadrant_gain = 0;        // c1, N m a N m
  double quadrant_step_nm = 0;     // c2
  double quadrant_width_nm = 0.5;  // g0 > 0

  // [N m]; any finite arguments.
  double at(double velocity_rad_s, double gravity_nm) const;
  // The same at one velocity and a column of gravity torques, bit for bit.
  std::vector<double> at(double velocity_rad_s, std::span<const double> gravity_nm) const;
  // The mean over a stroke that is symmetric in the load: what is left of `at` without c0, c1, c2.
  double averaged_at(double velocity_rad_s) const;

  // The law as a formula over qd, sgn_qd (and g, sgn_g where it depends on the load), with
  // `offset_nm` added; equal to the functions above wherever qd and g are not 0.
  std::string formula(bool with_load, double offset_nm = 0) const;
};

// Position-dependent ripple: sum of amplitude * cos(order * q + phase).
struct Harmonic {
  double amplitude_nm = 0;
  double order = 0;  // periods a turn of the joint
  double phase_rad = 0;
};
double ripple_at(std::span<const Harmonic> harmonics, double position_rad);
std::vector<double> ripple_at(std::span<const Harmonic> harmonics,
                              std::span<const double> positions_rad);

}  // namespace tribench
