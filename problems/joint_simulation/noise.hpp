// SPDX-License-Identifier: MIT
//
// What no model can explain, in the shapes that real recordings have it.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::simulation {

enum class NoiseKind {
  gaussian,
  skewed,           // a gamma law: long to one side
  quantised,        // a sensor with steps of two and a half standard deviations
  heteroscedastic,  // four times as loud at top speed, a level of its own a movement
  heavy_tailed,     // Student t with 3 degrees of freedom
  bursty,           // stretches of some twenty rows four times as loud, 8 % of the time
  correlated,       // 0.9 between neighbouring rows
  half_slow,        // half of the variance 0.95 between neighbouring rows, the other half white
};
std::string_view noise_name(NoiseKind kind);
inline constexpr std::array kNoiseKinds = {
    NoiseKind::gaussian,     NoiseKind::skewed, NoiseKind::quantised,  NoiseKind::heteroscedastic,
    NoiseKind::heavy_tailed, NoiseKind::bursty, NoiseKind::correlated, NoiseKind::half_slow};

// Of the rows of one movement: variance about 1, mean 0. Of quantised noise it is what comes before
// the rounding. velocity in rad/s.
std::vector<double> movement_noise(NoiseKind kind, std::span<const double> velocity,
                                   RandomStream random);

// The step of a quantised sensor, in standard deviations; 0 for other kinds.
double quantisation_step(NoiseKind kind);

}  // namespace tribench::simulation
