// SPDX-License-Identifier: MIT
//
// Student's t, with a law of its own on either side of 0 where the noise is skewed, fitted to noise
// with heavy tails. Internal to the room. Not for a location: half of what is fitted lies above 0.
// Values are finite; a fit costs a few passes over them for each of the degrees of freedom tried.
#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

struct StudentSide {
  double freedom = 5;
  double scale = 1;
  // Its density is this to the power -(freedom + 1) / 2, but for a constant.
  double kernel(double z) const { return 1 + z * z / (freedom * scale * scale); }
  double information() const { return 2 * freedom / (freedom + 3); }  // a row's about ln scale
  bool operator==(const StudentSide&) const = default;
};

struct StudentLaw {
  StudentSide below;
  StudentSide above;
  double log_density_ratio = 0;  // ln of the density just above 0 over that just below

  StudentLaw() = default;
  StudentLaw(double freedom, double scale) : below{freedom, scale}, above{freedom, scale} {}

  bool is_even() const { return below == above; }
  const StudentSide& side(double z) const { return z > 0 ? above : below; }
  double kernel(double z) const { return side(z).kernel(z); }
  double scale() const { return std::sqrt(below.scale * above.scale); }     // typical
  double wider_side() const { return below.scale > above.scale ? -1 : 1; }  // sign
  StudentLaw times(double factor) const {
    StudentLaw out = *this;
    out.below.scale *= factor;
    out.above.scale *= factor;
    return out;
  }
  // What so many rows leave open of the logarithm of their scale.
  double variance_of_log_level(double rows) const {
    return 2 / (rows * (below.information() + above.information()));
  }
  // Bailey 1994: one draw from two uniform ones. Of a mirrored law it is the negative.
  double draw(RandomStream& random) const {
    const double u = 1 - random.uniform();
    const double cosine = wider_side() * elementary::cos(random.uniform(0, 2 * std::numbers::pi));
    const StudentSide& own = side(cosine);
    return own.scale * std::sqrt(own.freedom * (elementary::pow(u, -2 / own.freedom) - 1)) * cosine;
  }
};

// By maximum likelihood over a few degrees of freedom (3 to 40); the scale by iterated weights
// (Lange, Little and Taylor 1989). Each side for itself where that is likelier by more than its two
// further parameters are worth (Schwarz 1978). For noise of a scale near 1.
StudentLaw fit_student(std::span<const double> z);

// Of the typical noise a level is at least this share.
inline constexpr double kLeastLevel = 0.02;
inline constexpr int kLevelIterations = 8;  // each leaves a third of the error

// The scale of z as a multiple of the law's, by maximum likelihood, from `level` on.
double level_of(std::span<const double> z, const StudentLaw& law, double level, int iterations);

}  // namespace tribench::loop
