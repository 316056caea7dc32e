// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace tribench::simulation {
namespace {

struct Moments {
  double mean = 0;
  double variance = 0;
  double skewness = 0;
  double kurtosis = 0;
  double neighbours = 0;  // correlation of neighbouring rows
  double levels = 0;      // of the magnitudes of neighbouring rows
};

double correlation_of_neighbours(const std::vector<double>& x) {
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  double above = 0;
  double below = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    below += (x[i] - mean) * (x[i] - mean);
    if (i > 0) above += (x[i] - mean) * (x[i - 1] - mean);
  }
  return above / below;
}

Moments moments_of(NoiseKind kind, double velocity) {
  const std::vector<double> velocities(200'000, velocity);
  const std::vector<double> x = movement_noise(kind, velocities, RandomStream(11));
  Moments m;
  const auto n = static_cast<double>(x.size());
  for (const double value : x) m.mean += value / n;
  for (const double value : x) m.variance += std::pow(value - m.mean, 2) / n;
  for (const double value : x) {
    const double z = (value - m.mean) / std::sqrt(m.variance);
    m.skewness += z * z * z / n;
    m.kurtosis += z * z * z * z / n;
  }
  m.neighbours = correlation_of_neighbours(x);
  std::vector<double> sizes;
  for (const double value : x) sizes.push_back(std::min(std::abs(value), 5.0));
  m.levels = correlation_of_neighbours(sizes);
  return m;
}

// Gamma with shape 2: skewness sqrt 2, kurtosis 6. Bursts: kurtosis 3 E s^4 / (E s^2)^2.
TEST(Noise, EachKindHasTheMomentsOfItsLaw) {
  for (const NoiseKind kind :
       {NoiseKind::gaussian, NoiseKind::skewed, NoiseKind::quantised, NoiseKind::bursty}) {
    const Moments m = moments_of(kind, 0.2);
    EXPECT_NEAR(m.mean, 0, 0.02) << noise_name(kind);
    EXPECT_NEAR(m.variance, 1, 0.06) << noise_name(kind);
    EXPECT_NEAR(m.neighbours, 0, 0.01) << noise_name(kind);
  }
  EXPECT_NEAR(moments_of(NoiseKind::skewed, 0.2).skewness, std::sqrt(2.0), 0.05);
  EXPECT_NEAR(moments_of(NoiseKind::gaussian, 0.2).kurtosis, 3, 0.05);
  EXPECT_NEAR(moments_of(NoiseKind::bursty, 0.2).kurtosis,
              3 * (0.92 + 0.08 * 256) / std::pow(0.92 + 0.08 * 16, 2), 1.2);
  EXPECT_GT(moments_of(NoiseKind::heavy_tailed, 0.2).kurtosis, 10);
  EXPECT_NEAR(moments_of(NoiseKind::correlated, 0.2).neighbours, 0.9, 0.01);
  EXPECT_NEAR(moments_of(NoiseKind::half_slow, 0.2).neighbours, 0.475, 0.02);
  EXPECT_NEAR(moments_of(NoiseKind::half_slow, 0.2).variance, 1, 0.06);
  EXPECT_GT(moments_of(NoiseKind::bursty, 0.2).levels, 0.3);
  EXPECT_LT(moments_of(NoiseKind::gaussian, 0.2).levels, 0.02);
}

TEST(Noise, HeteroscedasticNoiseGrowsFourfoldWithSpeed) {
  const double slow = moments_of(NoiseKind::heteroscedastic, 0).variance;
  const double fast = moments_of(NoiseKind::heteroscedastic, 0.8).variance;
  EXPECT_NEAR(std::sqrt(fast / slow), 4, 0.01);
}

}  // namespace
}  // namespace tribench::simulation
