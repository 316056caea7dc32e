// SPDX-License-Identifier: MIT
//
// The two joints of the generated robot (KUKA LWR IV+ class, pitch axes 2 and 4) with every number
// of the generator in one place.
//
// Source: the specification of the closed loop, sections 8.1 to 8.3. Gravity amplitudes and levers
// come from the public model of the arm (kuka-isir/rtt_lwr), the rest is fitted or chosen so that
// the errors that Scholl et al. 2025 print come out.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "problems/friction/law.hpp"

namespace tribench::kuka {

inline constexpr double kStandardGravity = 9.81;  // m/s^2
inline constexpr double kSampleRate_hz = 1000;
inline constexpr double kStrokeEnd_rad = 2.0;  // movements of A cross [-2, 2] rad
inline constexpr int kSpeeds = 45;             // of A, in both directions: 90 movements
inline constexpr double kSlowest_rad_s = 0.015;
inline constexpr double kFastest_rad_s = 0.68;
inline constexpr double kPayload_kg = 1.5;  // of B with load

struct Joint {
  int number = 0;
  FrictionLaw law;
  double gravity_amplitude_nm = 0;  // G: gravity torque is G sin(q) in A
  double payload_lever_m = 0;       // a payload adds 9.81 m lever to G
  std::array<Harmonic, 3> ripple;   // phases are drawn with the seed
  double sample_noise_nm = 0;       // sd of w, per 1 kHz sample
  double movement_noise_nm = 0;     // sd of b_m, one draw a movement

  // Dataset B differs from A by a shift that no channel declares: k0 + k1 s + k2 s |g|.
  double shift_offset_nm = 0;
  double shift_coulomb_nm = 0;
  double shift_load = 0;
  double noise_scale_b = 1;  // of ripple and noise in B

  double shift_at(double velocity_rad_s, double gravity_nm) const;
  // The same over sgn_qd, g and sgn_g, wherever qd and g are not 0.
  std::string shift_formula() const;
  // Mean of the ripple over the stroke of A [N m].
  double mean_ripple_nm() const;
};

// number: 2 or 4. The same joint for the same seed, in every dataset.
Joint make_joint(int number, std::uint64_t seed);

// The speeds of A [rad/s], uniform from slowest to fastest.
std::vector<double> commanded_speeds();

}  // namespace tribench::kuka
