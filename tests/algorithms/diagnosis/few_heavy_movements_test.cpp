// SPDX-License-Identifier: MIT
//
// An effect that most movements show a little, and a few so much that they are the error of its
// gain.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

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

// Strokes to and fro at speeds from slow to fast, as friction is usually measured, drawn in any
// order while the joint warms up: viscous friction falls, and only the fast ones show it.
Observations strokes_while_warming_up(std::uint64_t seed) {
  constexpr double kStep = 0.02;
  constexpr std::size_t kPairs = 28;
  RandomStream random(seed);
  std::vector<double> speeds;
  for (std::size_t k = 0; k < kPairs; ++k) {
    speeds.push_back(0.02 * std::pow(100, static_cast<double>(k % 14) / 13));
  }
  for (std::size_t k = kPairs; k-- > 1;) {
    const double other = random.uniform(0, static_cast<double>(k + 1));
    std::swap(speeds[k], speeds[static_cast<std::size_t>(other)]);
  }
  std::string text = "movement,time_s,v,temperature_degC,friction_torque_Nm\n";
  double t = 0;
  double noise = 0;
  for (std::size_t m = 0; m < 2 * kPairs; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double speed = speeds[m / 2];
    const double offset = 0.06 * random.normal();
    const double end = t + std::clamp(2.5 * speed, 0.1, 1.6) / speed;
    for (; t < end; t += kStep) {
      const double temperature = 38 - 14 * std::exp(-t / 50);
      const double viscous = 4 + 4 * std::exp(-(temperature - 24) / 12);
      noise = 0.3 * noise + 0.2 * random.normal();
      text += fmt::format("{},{},{},{},{}\n", m, t, s * speed, temperature,
                          s * (6 + viscous * speed) + offset + noise);
    }
    t += 1;
  }
  return observe(parse_csv(text, "strokes.csv").data);
}

TEST(FewHeavyMovements, DoNotHideWhatTheOthersShowToo) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Diagnosis diagnosis = diagnose(strokes_under_loads(seed), coulomb_viscous_base, {});
    EXPECT_THAT(families(diagnosis), ::testing::ElementsAre("load_coulomb")) << seed;
  }
}

// Flips of so few cannot even reach the p from which on the specification looks at a gain.
TEST(FewHeavyMovements, AreHeardWhateverTheirFlipsSay) {
  for (const std::uint64_t seed : {4U, 25U, 33U, 37U, 52U}) {
    const Diagnosis diagnosis = diagnose(strokes_while_warming_up(seed), coulomb_viscous_base, {});
    EXPECT_THAT(families(diagnosis), ::testing::ElementsAre("temperature")) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
