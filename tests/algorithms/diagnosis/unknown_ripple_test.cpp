// SPDX-License-Identifier: MIT
//
// Ripples of a gear whose ratio nobody has told, or told wrongly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "tests/algorithms/diagnosis/half_sines.hpp"

namespace tribench::loop {
namespace {

Observations strokes_over(const std::function<double(double)>& torque_of) {
  return half_sines_over({.movements = 30, .rows = 200, .seed = 11}, torque_of);
}

Diagnosis diagnose_strokes(const std::function<double(double)>& torque_of,
                           std::vector<double> gear_ratios = {}) {
  DiagnosisOptions options;
  options.gear_ratios = std::move(gear_ratios);
  return diagnose(strokes_over(torque_of), coulomb_viscous_base, options);
}

double ratio_of(const EffectFinding& effect) {
  const auto found = std::ranges::find(effect.parameters, "N", &ParameterFinding::name);
  return found == effect.parameters.end() ? 0 : found->value;
}

TEST(UnknownRipple, IsNamedWithItsPeriodWhateverRatioIsTold) {
  for (const double wavenumber : {23.7, 88.2, 291.6, 900.3}) {
    const auto ripple = [&](double q) { return kHalfSinesNoise * std::cos(wavenumber * q + 1); };
    for (const std::vector<double>& told : {std::vector<double>{}, std::vector<double>{60}}) {
      const Diagnosis diagnosis = diagnose_strokes(ripple, told);
      EXPECT_EQ(diagnosis.verdict, Verdict::effects) << wavenumber;
      ASSERT_EQ(diagnosis.effects.size(), 1U) << wavenumber;
      EXPECT_EQ(diagnosis.effects[0].family, "gear_ripple");
      EXPECT_NEAR(ratio_of(diagnosis.effects[0]), wavenumber, 0.1);
      EXPECT_FALSE(diagnosis.leftover.repeating.has_value());
      EXPECT_LT(diagnosis.shortest_wave, 2 * std::numbers::pi / wavenumber);
    }
  }
}

// No gear is a sine: what else repeats is smaller than the ripple itself. Here that is where a
// usual gear has its ripple (121), and is found first.
TEST(UnknownRipple, IsTheLargestOfWhatRepeats) {
  const auto ripple = [](double q) {
    return kHalfSinesNoise * (std::cos(40.3 * q + 1) + 0.6 * std::cos(3 * 40.3 * q));
  };
  const Diagnosis diagnosis = diagnose_strokes(ripple);
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  EXPECT_EQ(diagnosis.effects[0].family, "gear_ripple");
  EXPECT_NEAR(ratio_of(diagnosis.effects[0]), 40.3, 0.1);
}

// A strong wave over many rows each passes for correlation of the noise, and its harmonic is what
// is most certain; where every stretch agrees that is beside the top of the wave.
TEST(UnknownRipple, IsFoundThoughTheNoiseHasTakenMostOfIt) {
  for (const double wavenumber : {10.4, 13.7, 20.0}) {
    const Diagnosis diagnosis = diagnose_strokes([&](double q) {
      return 8 * kHalfSinesNoise *
             (std::sin(wavenumber * q + 0.9) + 0.3 * std::sin(2 * wavenumber * q));
    });
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << wavenumber;
    ASSERT_EQ(diagnosis.effects.size(), 1U) << wavenumber;
    EXPECT_EQ(diagnosis.effects[0].family, "gear_ripple");
    EXPECT_NEAR(ratio_of(diagnosis.effects[0]), wavenumber, 0.1);
  }
}

// The joint's own teeth and bearings have whole numbers of waves a turn, too.
TEST(UnknownRipple, OfAWholeNumberOfWavesATurnMayBeTheJoints) {
  for (const double wavenumber : {12.0, 12.4}) {
    const Diagnosis diagnosis = diagnose_strokes(
        [&](double q) { return 2 * kHalfSinesNoise * std::cos(wavenumber * q + 1); });
    ASSERT_EQ(diagnosis.effects.size(), 1U) << wavenumber;
    const auto& aliases = diagnosis.effects[0].aliases;
    EXPECT_EQ(std::ranges::count(aliases, "output_ripple (12 a turn)", &AliasFinding::family),
              wavenumber == 12.0 ? 1 : 0);
  }
}

// What is there at one place alone has waves of all lengths.
TEST(UnknownRipple, IsNoNotch) {
  const auto notch = [](double q) {
    const double x = (q - 0.2) / 0.03;
    return -4 * kHalfSinesNoise * std::exp(-x * x);
  };
  const Diagnosis diagnosis = diagnose_strokes(notch);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_TRUE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.leftover.inputs, std::vector<std::string>{"position"});
}

TEST(UnknownRipple, IsNotLookedForWithoutItsRule) {
  const auto ripple = [](double q) { return kHalfSinesNoise * std::cos(88.2 * q + 1); };
  DiagnosisOptions options;
  options.without = {"unknown_ripple"};
  const Diagnosis diagnosis = diagnose(strokes_over(ripple), coulomb_viscous_base, options);
  EXPECT_EQ(diagnosis.verdict, Verdict::none);
}

}  // namespace
}  // namespace tribench::loop
