// SPDX-License-Identifier: MIT
//
// Something at one place of the travel, wide enough for a few harmonics to come near it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "tests/algorithms/diagnosis/half_sines.hpp"

namespace tribench::loop {
namespace {

Diagnosis with_torque_over_place(const std::function<double(double)>& torque_of,
                                 std::vector<std::string> without = {}) {
  DiagnosisOptions options;
  options.gear_ratios = {100};
  options.without = std::move(without);
  return diagnose(half_sines_over({.movements = 30, .rows = 200, .seed = 21}, torque_of),
                  coulomb_viscous_base, options);
}

// A raised cosine: no Gaussian, and flat beyond.
double dent(double q) {
  const double x = (q - 0.15) / 0.45;
  if (std::abs(x) > 1) return 0;
  return -3 * kHalfSinesNoise * (1 + std::cos(std::numbers::pi * x));
}

TEST(LocalDefect, IsNoSumOfRipples) {
  const Diagnosis diagnosis = with_torque_over_place(dent);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_TRUE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.leftover.inputs, std::vector<std::string>{"position"});
}

TEST(LocalDefect, PassesForRipplesWithoutItsRule) {
  const Diagnosis diagnosis = with_torque_over_place(dent, {"local_defect"});
  ASSERT_FALSE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.effects[0].family, "output_ripple");
}

TEST(LocalDefect, IsNotWhatRepeats) {
  for (const double waves : {2.0, 3.0, 5.0}) {
    const Diagnosis diagnosis = with_torque_over_place(
        [&](double q) { return 2 * kHalfSinesNoise * std::cos(waves * q + 1); });
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << waves;
    ASSERT_EQ(diagnosis.effects.size(), 1U) << waves;
    EXPECT_EQ(diagnosis.effects[0].family, "output_ripple") << waves;
  }
}

}  // namespace
}  // namespace tribench::loop
