// SPDX-License-Identifier: MIT
//
// Ripples of a gear whose ratio nobody has told, or told wrongly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "foundation/random.hpp"
#include "problems/reading/csv.hpp"

namespace tribench::loop {
namespace {

constexpr double kNoiseOfStrokes = 0.25;  // N m
constexpr int kStrokes = 30;
constexpr int kRowsOfStroke = 200;

// Half sines one way and the other over a torque that depends on the place.
Observations strokes_over(const std::function<double(double)>& torque_of) {
  RandomStream random(11);
  std::string text = "movement,q,v,friction_torque_Nm\n";
  for (int m = 0; m < kStrokes; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double reach = random.uniform(0.9, 1.3);
    for (int i = 1; i < kRowsOfStroke; ++i) {
      const double phase = std::numbers::pi * i / kRowsOfStroke;
      const double q = -s * reach * std::cos(phase);
      const double v = s * reach * w * std::sin(phase);
      const double torque = 4 * s + 6 * v + torque_of(q) + kNoiseOfStrokes * random.normal();
      text += fmt::format("{},{},{},{}\n", m, q, v, torque);
    }
  }
  return observe(parse_csv(text, "strokes.csv").data);
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
  for (const double wavenumber : {23.7, 88.2, 291.6}) {
    const auto ripple = [&](double q) { return kNoiseOfStrokes * std::cos(wavenumber * q + 1); };
    for (const std::vector<double>& told : {std::vector<double>{}, std::vector<double>{60}}) {
      const Diagnosis diagnosis = diagnose_strokes(ripple, told);
      EXPECT_EQ(diagnosis.verdict, Verdict::effects) << wavenumber;
      ASSERT_EQ(diagnosis.effects.size(), 1U) << wavenumber;
      EXPECT_EQ(diagnosis.effects[0].family, "gear_ripple");
      EXPECT_NEAR(ratio_of(diagnosis.effects[0]), wavenumber, 0.1);
      EXPECT_FALSE(diagnosis.leftover.repeating.has_value());
    }
  }
}

// No gear is a sine: what else repeats is smaller than the ripple itself. Here that is where a
// usual gear has its ripple (121), and is found first.
TEST(UnknownRipple, IsTheLargestOfWhatRepeats) {
  const auto ripple = [](double q) {
    return kNoiseOfStrokes * (std::cos(40.3 * q + 1) + 0.6 * std::cos(3 * 40.3 * q));
  };
  const Diagnosis diagnosis = diagnose_strokes(ripple);
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  EXPECT_EQ(diagnosis.effects[0].family, "gear_ripple");
  EXPECT_NEAR(ratio_of(diagnosis.effects[0]), 40.3, 0.1);
}

// What is there at one place alone has waves of all lengths.
TEST(UnknownRipple, IsNoNotch) {
  const auto notch = [](double q) {
    const double x = (q - 0.2) / 0.03;
    return -4 * kNoiseOfStrokes * std::exp(-x * x);
  };
  const Diagnosis diagnosis = diagnose_strokes(notch);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_TRUE(diagnosis.effects.empty());
  EXPECT_EQ(diagnosis.leftover.inputs, std::vector<std::string>{"position"});
}

TEST(UnknownRipple, IsNotLookedForWithoutItsRule) {
  const auto ripple = [](double q) { return kNoiseOfStrokes * std::cos(88.2 * q + 1); };
  DiagnosisOptions options;
  options.without = {"unknown_ripple"};
  const Diagnosis diagnosis = diagnose(strokes_over(ripple), coulomb_viscous_base, options);
  EXPECT_EQ(diagnosis.verdict, Verdict::none);
}

}  // namespace
}  // namespace tribench::loop
