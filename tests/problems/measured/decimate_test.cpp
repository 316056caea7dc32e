// SPDX-License-Identifier: MIT
#include "problems/measured/decimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tribench::measured {
namespace {

std::vector<double> tone(double cycles_per_sample, std::size_t samples) {
  std::vector<double> values;
  for (std::size_t i = 0; i < samples; ++i) {
    values.push_back(
        std::sin(2 * std::numbers::pi * cycles_per_sample * static_cast<double>(i) + 0.3));
  }
  return values;
}

TEST(Decimate, KeepsConstantsAndSlowTones) {
  const std::vector<double> constant(1000, 3.5);
  for (const double value : decimate(constant, 10)) EXPECT_NEAR(value, 3.5, 1e-9);
  const std::vector<double> slow = tone(0.01, 2000);
  const std::vector<double> kept = decimate(slow, 10);
  ASSERT_EQ(kept.size(), 200U);
  // Away from the ends the pass band is flat to twice 0.05 dB, 1.2 %, and has no phase.
  for (std::size_t i = 20; i < 180; ++i) EXPECT_NEAR(kept[i], slow[10 * i], 0.013);
}

TEST(Decimate, RemovesWhatWouldAlias) {
  // Above the new Nyquist frequency of 0.05 cycles a sample.
  const std::vector<double> kept = decimate(tone(0.09, 3000), 10);
  for (std::size_t i = 20; i < 280; ++i) EXPECT_LT(std::abs(kept[i]), 1e-3);
}

TEST(Decimate, ByOneIsACopyAndShortSignalsAreThinnedOnly) {
  const std::vector<double> signal = {1, 5, 2, 4, 3};
  EXPECT_EQ(decimate(signal, 1), signal);
  EXPECT_EQ(decimate(signal, 2), (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(decimate({}, 3).empty());
}

}  // namespace
}  // namespace tribench::measured
