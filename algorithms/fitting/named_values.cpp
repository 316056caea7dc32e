// SPDX-License-Identifier: MIT
#include "algorithms/fitting/named_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace tribench {

namespace {

constexpr int kDigits = 6;
constexpr double kNearDecimal = 1e-8;  // of the value: nearly every number has a decimal nearby

}  // namespace

std::vector<double> named_values(double c) {
  std::vector<double> values;
  const auto consider = [&](double value) {
    const bool is_near = std::abs(c - value) <= kNearNamed * std::abs(value);
    if (is_near && value != 0 && std::ranges::count(values, value) == 0) values.push_back(value);
  };
  constexpr int kDenominators[] = {1, 2, 3, 4, 5, 6, 8, 10, 12};
  for (const int q : kDenominators) {
    const double p = std::nearbyint(c * q);
    if (std::abs(p) <= 1000) consider(p / q);
  }
  constexpr double kRoots[] = {std::numbers::pi,     std::numbers::sqrt2,      std::numbers::sqrt3,
                               std::numbers::inv_pi, std::numbers::inv_sqrtpi, std::numbers::e,
                               std::numbers::ln10,   std::numbers::ln2};
  for (const double root : kRoots) {
    for (const int q : kDenominators) {
      const double p = std::nearbyint(c / root * q);
      if (std::abs(p) <= 12) consider(root * (p / q));
    }
  }
  for (int digits = 2; digits <= kDigits; ++digits) {
    const double decimal = std::strtod(fmt::format("{:.{}g}", c, digits).c_str(), nullptr);
    if (std::abs(c - decimal) > kNearDecimal * std::abs(decimal)) continue;
    consider(decimal);
    break;
  }
  return values;
}

}  // namespace tribench
