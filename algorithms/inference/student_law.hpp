// SPDX-License-Identifier: MIT
//
// Student's t with a scale, fitted to noise with heavy tails. Internal to the room. Not for a
// location: what is fitted lies around 0. Values are finite; a fit costs a few passes over them for
// each of the degrees of freedom tried.
#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

struct StudentLaw {
  double freedom = 5;
  double scale = 1;
  // Its density is this to the power -(freedom + 1) / 2, but for a constant.
  double kernel(double z) const { return 1 + z * z / (freedom * scale * scale); }
  // What so many rows leave open of the logarithm of their scale: the information of this law.
  double variance_of_log_level(double rows) const { return (freedom + 3) / (2 * freedom * rows); }
  // Bailey 1994: one draw from two uniform ones.
  double draw(RandomStream& random) const {
    const double u = 1 - random.uniform();
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    return scale * std::sqrt(freedom * (elementary::pow(u, -2 / freedom) - 1)) *
           elementary::cos(angle);
  }
};

// By maximum likelihood over a few degrees of freedom (3 to 40); the scale by iterated weights
// (Lange, Little and Taylor 1989). For noise of a scale near 1.
StudentLaw fit_student(std::span<const double> z);

// Of the typical noise a level is at least this share.
inline constexpr double kLeastLevel = 0.02;
inline constexpr int kLevelIterations = 8;  // each leaves a third of the error

// The scale of z as a multiple of the law's, by maximum likelihood, from `level` on.
double level_of(std::span<const double> z, const StudentLaw& law, double level, int iterations);

}  // namespace tribench::loop
