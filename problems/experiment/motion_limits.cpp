// SPDX-License-Identifier: MIT
#include "problems/experiment/motion_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kRounding = 1e-6;  // of files with nine digits

// A stroke from rest to rest, as simulation::Movement makes it.
double stroke_seconds(double length_rad, double speed_rad_s, double acceleration_rad_s2) {
  if (length_rad <= 0) return 0;
  const double top = std::min(speed_rad_s, std::sqrt(length_rad * acceleration_rad_s2));
  return length_rad / top + top / acceleration_rad_s2;
}

double peak_speed(const PlannedMovement& movement) {
  if (!movement.is_two_tone()) return std::abs(movement.velocity);
  double speed = 0;
  for (const Tone& tone : movement.tones) {
    speed += 2 * std::numbers::pi * tone.frequency * tone.amplitude;
  }
  return speed;
}

// The largest |sin| between two angles.
double peak_sine(double low, double high) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  const double crest = kQuarter + std::numbers::pi * std::ceil((low - kQuarter) / std::numbers::pi);
  if (crest <= high) return 1;
  return std::max(std::abs(elementary::sin(low)), std::abs(elementary::sin(high)));
}

}  // namespace

double start_of(const PlannedMovement& movement) {
  return movement.is_two_tone() ? 0.5 * (movement.from + movement.to) : movement.from;
}

double end_of(const PlannedMovement& movement) {
  return movement.is_two_tone() ? 0.5 * (movement.from + movement.to) : movement.to;
}

double seconds_of(const PlannedMovement& movement, double position_rad,
                  const MotionLimits& limits) {
  const double approach =
      stroke_seconds(std::abs(start_of(movement) - position_rad),
                     kApproachSpeed * limits.speed_rad_s, limits.acceleration_rad_s2);
  if (movement.is_two_tone()) return approach + movement.duration;
  return approach + stroke_seconds(std::abs(movement.to - movement.from),
                                   std::abs(movement.velocity), limits.acceleration_rad_s2);
}

BrokenLimit broken_limit(const PlannedMovement& movement, const MotionLimits& limits) {
  const double low = std::min(movement.from, movement.to);
  const double high = std::max(movement.from, movement.to);
  if (low < limits.lowest_rad - kRounding || high > limits.highest_rad + kRounding) {
    return {fmt::format("positions from {:g} to {:g} rad leave the range", low, high),
            fmt::format("stay within {:g} and {:g} rad", limits.lowest_rad, limits.highest_rad)};
  }
  if (const double speed = peak_speed(movement); speed > limits.speed_rad_s * (1 + kRounding)) {
    return {fmt::format("a speed of {:g} rad/s is over the limit", speed),
            fmt::format("{:g} rad/s at most", limits.speed_rad_s)};
  }
  if (movement.load_factor < limits.least_load_factor - kRounding ||
      movement.load_factor > limits.greatest_load_factor + kRounding) {
    return {
        fmt::format("there is no load factor of {:g}", movement.load_factor),
        fmt::format("from {:g} to {:g}", limits.least_load_factor, limits.greatest_load_factor)};
  }
  const double gravity_nm =
      limits.gravity_nm * movement.load_factor *
      peak_sine(low + limits.gravity_phase_rad, high + limits.gravity_phase_rad);
  if (gravity_nm > limits.torque_nm) {
    return {fmt::format("gravity alone takes {:.4g} N m", gravity_nm),
            fmt::format("{:g} N m at most: less load, or another place", limits.torque_nm)};
  }
  if (movement.other_velocity > limits.greatest_other_velocity_rad_s * (1 + kRounding)) {
    return {fmt::format("the other joint cannot move at {:g} rad/s", movement.other_velocity),
            fmt::format("{:g} rad/s at most", limits.greatest_other_velocity_rad_s)};
  }
  if (movement.rest > limits.longest_rest_s) {
    return {fmt::format("a rest of {:g} s is too long", movement.rest),
            fmt::format("{:g} s at most, or two movements", limits.longest_rest_s)};
  }
  return {};
}

}  // namespace tribench
