// SPDX-License-Identifier: MIT
#include "problems/friction_sign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr double kLeastAgreement = -0.1;
constexpr double kCountsAsDirection = 0.1;  // of the other direction's top speed: else standstill

bool has_both_directions(std::span<const double> velocity) {
  const auto [low, high] = std::minmax_element(velocity.begin(), velocity.end());
  if (low == velocity.end()) return false;
  return std::min(-*low, *high) > kCountsAsDirection * std::max(-*low, *high);
}

}  // namespace

double friction_agreement(std::span<const double> friction, std::span<const double> velocity) {
  const auto n = static_cast<double>(friction.size());
  const bool centred = has_both_directions(velocity);
  double mean_f = 0;
  double mean_v = 0;
  for (std::size_t r = 0; centred && r < friction.size(); ++r) {
    mean_f += friction[r] / n;
    mean_v += velocity[r] / n;
  }
  double fv = 0;
  double ff = 0;
  double vv = 0;
  for (std::size_t r = 0; r < friction.size(); ++r) {
    fv += (friction[r] - mean_f) * (velocity[r] - mean_v);
    ff += (friction[r] - mean_f) * (friction[r] - mean_f);
    vv += (velocity[r] - mean_v) * (velocity[r] - mean_v);
  }
  return ff > 0 && vv > 0 ? fv / std::sqrt(ff * vv) : 0;
}

std::string mend_of_sign(bool turned) {
  return turned ? "leave --flip-sign out: it is what turned the torques' sign"
                : "give --flip-sign to change the sign of the torques";
}

void refuse_opposing_friction(std::span<const double> friction, const std::string& friction_name,
                              std::span<const double> velocity, const std::string& velocity_name,
                              const std::string& place, const std::string& mend) {
  const double measured = friction_agreement(friction, velocity);
  if (measured >= kLeastAgreement) return;
  throw_bad_input(
      fmt::format("'{}' opposes '{}' (correlation {:.2f}); friction is positive with velocity here",
                  friction_name, velocity_name, measured),
      place, mend);
}

}  // namespace tribench
