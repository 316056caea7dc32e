// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/noise.hpp"

#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::simulation {
namespace {

constexpr double kTopSpeed_rad_s = 0.8;

// Gamma with shape 2: a sum of two exponentials, mean 2 and variance 2.
double skewed(RandomStream& random) {
  const double sum = -elementary::log((1 - random.uniform()) * (1 - random.uniform()));
  return (sum - 2) / std::sqrt(2.0);
}

// Student t with 3 degrees of freedom has variance 3.
double heavy_tailed(RandomStream& random) {
  const double normal = random.normal();
  double squares = 0;
  for (int i = 0; i < 3; ++i) {
    const double x = random.normal();
    squares += x * x;
  }
  return normal / std::sqrt(squares);
}

void add_bursts(std::vector<double>& noise, RandomStream random) {
  constexpr double kLoud = 4;
  constexpr double kRows = 20;
  constexpr double kShare = 0.08;
  const double quiet = 1 / std::sqrt(1 - kShare + kShare * kLoud * kLoud);
  bool loud = random.chance(kShare);
  for (double& value : noise) {
    value *= loud ? kLoud * quiet : quiet;
    const double leaves = loud ? 1 / kRows : kShare / ((1 - kShare) * kRows);
    if (random.chance(leaves)) loud = !loud;
  }
}

void correlate(std::vector<double>& noise, double correlation) {
  const double fresh = std::sqrt(1 - correlation * correlation);
  for (std::size_t i = 1; i < noise.size(); ++i) {
    noise[i] = correlation * noise[i - 1] + fresh * noise[i];
  }
}

void add_slow_half(std::vector<double>& noise, RandomStream random) {
  std::vector<double> slow(noise.size());
  for (double& value : slow) value = random.normal();
  correlate(slow, 0.95);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = (noise[i] + slow[i]) / std::sqrt(2.0);
}

void grow_with_speed(std::vector<double>& noise, std::span<const double> velocity, double level) {
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] *= level * (0.5 + 1.5 * std::abs(velocity[i]) / kTopSpeed_rad_s);
  }
}

}  // namespace

std::string_view noise_name(NoiseKind kind) {
  constexpr std::array<std::string_view, kNoiseKinds.size()> kNames = {
      "gaussian",     "skewed", "quantised",  "heteroscedastic",
      "heavy_tailed", "bursty", "correlated", "half_slow"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<double> movement_noise(NoiseKind kind, std::span<const double> velocity,
                                   RandomStream random) {
  RandomStream values = random.split("values");
  std::vector<double> noise(velocity.size());
  for (double& value : noise) {
    value = kind == NoiseKind::skewed         ? skewed(values)
            : kind == NoiseKind::heavy_tailed ? heavy_tailed(values)
                                              : values.normal();
  }
  RandomStream level = random.split("level");
  if (kind == NoiseKind::bursty) add_bursts(noise, level);
  if (kind == NoiseKind::correlated) correlate(noise, 0.9);
  if (kind == NoiseKind::half_slow) add_slow_half(noise, level);
  if (kind == NoiseKind::heteroscedastic) {
    grow_with_speed(noise, velocity, elementary::exp(0.4 * level.normal()));
  }
  return noise;
}

double quantisation_step(NoiseKind kind) { return kind == NoiseKind::quantised ? 2.5 : 0; }

}  // namespace tribench::simulation
