// SPDX-License-Identifier: MIT
//
// The place of the least value of a function of one number between two bounds, where it has one
// minimum there. Each step narrows the bounds by 0.62 and asks twice; NaN counts as no less.
// Source: Kiefer 1953.
#pragma once

#include <numbers>

namespace tribench::relay {

template <typename F>
double least_by_golden_sections(const F& value, double low, double high, int steps) {
  for (int k = 0; k < steps; ++k) {
    const double part = (high - low) / std::numbers::phi;
    if (value(high - part) < value(low + part)) {
      high = low + part;
    } else {
      low = high - part;
    }
  }
  return (low + high) / 2;
}

}  // namespace tribench::relay
