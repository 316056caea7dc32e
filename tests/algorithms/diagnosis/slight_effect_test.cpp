// SPDX-License-Identifier: MIT
//
// What many rows make significant, and what is worth something.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "foundation/random.hpp"
#include "problems/reading/csv.hpp"

namespace tribench::loop {
namespace {

constexpr double kNoise = 0.25;  // N m
constexpr int kMovements = 24;
constexpr int kRows = 500;

// Half sines one way and the other with a wave of the joint's turn, `size` standard deviations of
// the noise in root mean square.
Diagnosis diagnose_wave(double size) {
  RandomStream random(7);
  std::string text = "movement,q,v,friction_torque_Nm\n";
  for (int m = 0; m < kMovements; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double reach = random.uniform(0.9, 1.3);
    for (int i = 1; i < kRows; ++i) {
      const double phase = std::numbers::pi * i / kRows;
      const double q = -s * reach * std::cos(phase);
      const double v = s * reach * w * std::sin(phase);
      const double wave = std::numbers::sqrt2 * size * kNoise * std::cos(8 * q);
      text +=
          fmt::format("{},{},{},{}\n", m, q, v, 4 * s + 6 * v + wave + kNoise * random.normal());
    }
  }
  return diagnose(observe(parse_csv(text, "waves.csv").data), coulomb_viscous_base, {});
}

TEST(SlightEffect, IsNotToldHoweverManyRowsMakeItSignificant) {
  const Diagnosis diagnosis = diagnose_wave(0.07);
  EXPECT_EQ(diagnosis.verdict, Verdict::none);
  EXPECT_TRUE(diagnosis.effects.empty());
  EXPECT_TRUE(diagnosis.leftover.inputs.empty());
}

TEST(SlightEffect, IsToldWhereItIsWorthMoreThanAHundredthOfWhatIsLeft) {
  const Diagnosis diagnosis = diagnose_wave(0.2);
  ASSERT_EQ(diagnosis.effects.size(), 1U);
  EXPECT_EQ(diagnosis.effects[0].family, "output_ripple");
}

}  // namespace
}  // namespace tribench::loop
