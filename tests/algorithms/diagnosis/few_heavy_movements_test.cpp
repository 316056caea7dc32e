// SPDX-License-Identifier: MIT
//
// An effect that most movements show a little, and a few so much that they are the error of its
// gain.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "foundation/random.hpp"
#include "problems/reading/csv.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

// Strokes with friction that grows with the load, which is heavy in a few of them.
Observations strokes_under_loads(std::uint64_t seed) {
  constexpr int kRows = 60;
  RandomStream random(seed);
  std::string text = "movement,q,v,g,friction_torque_Nm\n";
  for (int m = 0; m < 40; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double load = std::exp(2 * random.normal());
    for (int i = 1; i < kRows; ++i) {
      const double phase = std::numbers::pi * i / kRows;
      const double q = -s * std::cos(phase);
      const double v = s * w * std::sin(phase);
      const double g = load * std::cos(q);
      const double torque = s * (4 + 0.1 * g) + 6 * v + 0.25 * random.normal();
      text += fmt::format("{},{},{},{},{}\n", m, q, v, g, torque);
    }
  }
  return observe(parse_csv(text, "strokes.csv").data);
}

TEST(FewHeavyMovements, DoNotHideWhatTheOthersShowToo) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Diagnosis diagnosis = diagnose(strokes_under_loads(seed), coulomb_viscous_base, {});
    EXPECT_THAT(families(diagnosis), ::testing::ElementsAre("load_coulomb")) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
