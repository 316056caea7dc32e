// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/world_motion.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace tribench::simulation {
namespace {

constexpr double kOtherRate_rad_s = 2.2;

}  // namespace

Movement motion_for(const PlannedMovement& wanted, const MotionLimits& limits) {
  Movement movement = [&] {
    if (!wanted.is_two_tone()) {
      Movement stroke(wanted.from);
      stroke.add_stroke(wanted.to, std::abs(wanted.velocity), limits.acceleration_rad_s2);
      return stroke;
    }
    std::array<Sine, 3> sines{};
    for (std::size_t k = 0; k < wanted.tones.size(); ++k) {
      sines[k] =
          Sine{wanted.tones[k].amplitude, 2 * std::numbers::pi * wanted.tones[k].frequency, 0};
    }
    return Movement(start_of(wanted), sines, wanted.duration);
  }();
  movement.gravity_nm = wanted.load_factor * limits.gravity_nm;
  movement.gravity_phase_rad = limits.gravity_phase_rad;
  if (wanted.other_velocity > 0) {
    movement.other = {wanted.other_velocity / kOtherRate_rad_s, kOtherRate_rad_s, 0};
  }
  return movement;
}

}  // namespace tribench::simulation
