// SPDX-License-Identifier: MIT
#include "problems/kuka/joint.hpp"

#include <fmt/format.h>

#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"

namespace tribench::kuka {
namespace {

Joint joint_two() {
  Joint joint;
  joint.number = 2;
  joint.law.positive = {7.84, 15.12, 3.98};
  joint.law.negative = {9.08, 16.06, 4.84};
  joint.law.load_coulomb = 0.03;
  joint.law.quadrant_gain = 0.080;
  joint.law.quadrant_step_nm = 1.35;
  joint.gravity_amplitude_nm = 42.4;
  joint.payload_lever_m = 0.868;
  joint.ripple = {{{1.10, 320, 0}, {0.60, 160, 0}, {0.60, 3, 0}}};
  joint.sample_noise_nm = 0.80;
  joint.movement_noise_nm = 0.050;
  joint.shift_offset_nm = 1.0;
  joint.shift_coulomb_nm = 0.7;
  joint.shift_load = 0.02;
  joint.noise_scale_b = 0.55;
  return joint;
}

Joint joint_four() {
  Joint joint;
  joint.number = 4;
  joint.law.positive = {6.30, 11.70, 2.75};
  joint.law.negative = {6.87, 12.15, 3.05};
  joint.law.load_coulomb = 0.03;
  joint.law.quadrant_gain = 0.040;
  joint.law.quadrant_step_nm = 0.30;
  joint.gravity_amplitude_nm = 12.2;
  joint.payload_lever_m = 0.468;
  joint.ripple = {{{0.75, 320, 0}, {0.42, 160, 0}, {0.38, 3, 0}}};
  joint.sample_noise_nm = 0.60;
  joint.movement_noise_nm = 0.078;
  joint.shift_offset_nm = 0.9;
  joint.shift_coulomb_nm = 0.5;
  joint.shift_load = 0.03;
  joint.noise_scale_b = 1.0;
  return joint;
}

}  // namespace

Joint make_joint(int number, std::uint64_t seed) {
  if (number != 2 && number != 4) {
    throw_bad_input(fmt::format("there is no joint {} in the generator", number), {},
                    "the joints are 2 and 4");
  }
  Joint joint = number == 2 ? joint_two() : joint_four();
  // gbar = G mean|sin q| over [-e, e] = G (1 - cos e) / e.
  joint.law.mean_load_nm =
      joint.gravity_amplitude_nm * (1 - elementary::cos(kStrokeEnd_rad)) / kStrokeEnd_rad;
  RandomStream random =
      RandomStream(key_of(fmt::format("kuka/j{}", number))).split(seed).split("ripple");
  for (Harmonic& harmonic : joint.ripple) harmonic.phase_rad = random.uniform(0, 2 * kPi);
  return joint;
}

double Joint::shift_at(double velocity_rad_s, double gravity_nm) const {
  const double s = velocity_rad_s > 0 ? 1.0 : (velocity_rad_s < 0 ? -1.0 : 0.0);
  return shift_offset_nm + s * (shift_coulomb_nm + shift_load * std::abs(gravity_nm));
}

std::string Joint::shift_formula() const {
  return fmt::format("{} + sgn_qd*({} + {}*sgn_g*g)", shift_offset_nm, shift_coulomb_nm,
                     shift_load);
}

double Joint::mean_ripple_nm() const {
  double mean = 0;
  for (const Harmonic& harmonic : ripple) {
    const double reach = harmonic.order * kStrokeEnd_rad;
    mean += harmonic.amplitude_nm * elementary::cos(harmonic.phase_rad) * elementary::sin(reach) /
            reach;
  }
  return mean;
}

std::vector<double> commanded_speeds() {
  std::vector<double> speeds(kSpeeds);
  for (int i = 0; i < kSpeeds; ++i) {
    speeds[static_cast<std::size_t>(i)] =
        kSlowest_rad_s + (kFastest_rad_s - kSlowest_rad_s) * i / (kSpeeds - 1);
  }
  return speeds;
}

}  // namespace tribench::kuka
