// SPDX-License-Identifier: MIT
#include "harness/exploration/recorded_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace tribench {
namespace {

constexpr double kBeyondLimits = 0.2;  // of their range: overshoot, and an encoder's zero
// Of the way that was asked for. Tones that swell from standstill reach two fifths of it;
// revolutions called rad reach a sixth.
constexpr double kLeastCovered = 0.25;
constexpr double kSameRate = 2.5;  // units differ by a factor of 6 or more
// Of shorter movements a joint that starts gently leaves out the most, and few rows hold the rest.
constexpr double kLongEnough_s = 1;

constexpr const char* kUnits =
    "are the units those of the columns' names (position_deg, velocity_deg_s), and on the joint's "
    "side of the gear?";

std::span<const double> values_of(const Dataset& rows, Role role) {
  const Channel* channel = rows.find(role);
  return channel == nullptr ? std::span<const double>() : channel->values;
}

// What the velocity says of the way between two rows.
double way_by_velocity(const Dataset& rows, std::size_t from, std::size_t to) {
  const std::span<const double> t = values_of(rows, Role::time);
  const std::span<const double> v = values_of(rows, Role::velocity);
  double way = 0;
  for (std::size_t i = std::min(from, to); i < std::max(from, to); ++i) {
    way += (t[i + 1] - t[i]) * (v[i] + v[i + 1]) / 2;
  }
  return from < to ? way : -way;
}

Misfit torque_misfit(const Dataset& rows, const MotionLimits& limits) {
  const bool has_motor = rows.find(Role::motor_torque) != nullptr;
  double largest = 0;
  for (const double torque :
       values_of(rows, has_motor ? Role::motor_torque : Role::friction_torque)) {
    largest = std::max(largest, std::abs(torque));
  }
  if (!(largest > kSameRate * limits.torque_nm)) return {};
  return {fmt::format("the recording's torque reaches {:.4g} N m, and the limit is {:g}", largest,
                      limits.torque_nm),
          "is it in N m, and on the joint's side of the gear?"};
}

}  // namespace

Misfit misfit_of(const Dataset& rows, const PlannedMovement& asked, const MotionLimits& limits) {
  const std::span<const double> q = values_of(rows, Role::position);
  const auto [lowest, highest] = std::ranges::minmax_element(q);
  const double beyond = kBeyondLimits * (limits.highest_rad - limits.lowest_rad);
  if (*lowest < limits.lowest_rad - beyond || *highest > limits.highest_rad + beyond) {
    return {fmt::format("the recording goes from {:.4g} to {:.4g} rad, and the limits from {:g} to "
                        "{:g}",
                        *lowest, *highest, limits.lowest_rad, limits.highest_rad),
            kUnits};
  }
  if (Misfit torque = torque_misfit(rows, limits); torque.is_one()) return torque;
  const std::span<const double> t = values_of(rows, Role::time);
  if (t.back() - t.front() < kLongEnough_s) return {};
  const auto [low, high] = std::minmax(asked.from, asked.to);
  const double covered = std::min(*highest, high) - std::max(*lowest, low);
  if (covered < kLeastCovered * (high - low)) {
    return {fmt::format("the recording goes from {:.4g} to {:.4g} rad, where {:.4g} to {:.4g} was "
                        "asked for",
                        *lowest, *highest, low, high),
            "record the movement that the file asks for; exit status 2 refuses it"};
  }
  const double way = *highest - *lowest;
  const double by_velocity = way_by_velocity(rows, static_cast<std::size_t>(lowest - q.begin()),
                                             static_cast<std::size_t>(highest - q.begin()));
  if (by_velocity * kSameRate > way && by_velocity < kSameRate * way) return {};
  return {
      fmt::format("the position goes {:.4g} rad where the velocity says {:.4g}", way, by_velocity),
      kUnits};
}

}  // namespace tribench
