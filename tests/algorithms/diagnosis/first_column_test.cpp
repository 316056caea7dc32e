// SPDX-License-Identifier: MIT
//
// Which column of a family a search begins with: fits of its shapes end near where they begin.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "foundation/random.hpp"
#include "problems/reading/csv.hpp"

namespace tribench::loop {
namespace {

constexpr double kStep = 0.02;
constexpr double kStribeck = 0.15;  // rad/s, of up to 3

// Half sines one way and the other, each from rest to rest.
Observations strokes(std::uint64_t seed) {
  RandomStream random(seed);
  std::string text = "movement,time_s,q,v,a,friction_torque_Nm\n";
  double begin = 0;
  for (int m = 0; m < 24; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double size = random.uniform(0.7, 1.2);
    const double seconds = std::numbers::pi / w;
    for (double t = kStep; t < seconds; t += kStep) {
      const double v = s * size * w * std::sin(w * t);
      const double fall = 3 * std::exp(-v * v / (kStribeck * kStribeck));
      text += fmt::format("{},{},{},{},{},{}\n", m, begin + t, -s * size * std::cos(w * t), v,
                          s * size * w * w * std::cos(w * t),
                          s * (4 + fall) + 6 * v + 0.25 * random.normal());
    }
    begin += seconds;
  }
  return observe(parse_csv(text, "strokes.csv").data);
}

// Wide curves leave their mark on more of each stroke, and so on more of the strokes; from a wide
// one the fit ended at its bound, and a second that all but cancelled it made up for that.
TEST(FirstColumn, IsTheOneThatExplainsMostAndNotTheOneThatMostMovementsAgreeOn) {
  for (const std::uint64_t seed : {9U, 24U, 25U, 30U, 36U, 41U}) {
    const Diagnosis diagnosis = diagnose(strokes(seed), coulomb_viscous_base, {});
    ASSERT_EQ(diagnosis.effects.size(), 1U) << seed;
    EXPECT_EQ(diagnosis.effects[0].family, "stribeck") << seed;
    ASSERT_EQ(diagnosis.effects[0].parameters.size(), 3U) << seed;  // of one column
    EXPECT_NEAR(diagnosis.effects[0].parameters[1].value, kStribeck, 0.02) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
