// SPDX-License-Identifier: MIT
//
// What is left over and significant, and worth nothing. That larger ones are told:
// diagnosis_test.cpp.
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

// Half sines one way and the other over a place where the torque dips, as no known effect does: by
// half the noise, over a twentieth of the way.
Diagnosis diagnose_dip() {
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
      const double x = (q - 0.2) / 0.06;
      const double dip = 0.45 * kNoise * std::exp(-x * x);
      text += fmt::format("{},{},{},{}\n", m, q, v, 4 * s + 6 * v - dip + kNoise * random.normal());
    }
  }
  return diagnose(observe(parse_csv(text, "dip.csv").data), coulomb_viscous_base, {});
}

TEST(SlightLeftover, IsNotToldHoweverManyRowsMakeItSignificant) {
  const Diagnosis diagnosis = diagnose_dip();
  EXPECT_EQ(diagnosis.verdict, Verdict::none);
  EXPECT_TRUE(diagnosis.leftover.inputs.empty());
  EXPECT_LT(diagnosis.leftover.p, 0.002);
}

}  // namespace
}  // namespace tribench::loop
