// SPDX-License-Identifier: MIT
//
// Offsets of movements that are like their neighbours', though no effect says why.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/algorithms/diagnosis/half_sines.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

// 40 strokes, there and back, without an effect but an offset of each, or friction: of the part of
// the campaign that has gone by.
Observations with_offsets(const std::function<double(double)>& offset, bool is_friction = false) {
  Observations data =
      half_sines_over({.movements = 40, .rows = 80, .seed = 3}, [](double) { return 0; });
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const double direction = is_friction ? data.find("sgn_v")->values[i] : 1;
    data.target[i] += kHalfSinesNoise * direction * offset(data.movement[i] / 40.);
  }
  return data;
}

bool is_sure_of_a_drift(const Diagnosis& diagnosis) {
  return diagnosis.effects.size() == 1 && diagnosis.effects[0].family == "drift" &&
         !diagnosis.effects[0].provisional && !diagnosis.effects[0].another_shape;
}

TEST(SerialOffsets, AZeroThatJumpsIsNoStraightDrift) {
  const Observations data = with_offsets([](double part) { return part < 0.45 ? -1 : 1; });
  const Diagnosis diagnosis = diagnose_most(data, {});
  EXPECT_NE(diagnosis.verdict, Verdict::none);
  for (const EffectFinding& effect : diagnosis.effects) {
    EXPECT_EQ(effect.family, "drift");
    EXPECT_TRUE(effect.another_shape);
    EXPECT_TRUE(effect.provisional);
  }
  EXPECT_LE(diagnosis.leftover.p, 0.001);
  DiagnosisOptions options;
  options.without = {"serial_offsets"};
  EXPECT_TRUE(is_sure_of_a_drift(diagnose_most(data, options)));
}

TEST(SerialOffsets, FrictionThatComesAndGoesIsNotNothing) {
  const Observations data = with_offsets(
      [](double part) { return 1.2 * std::sin(2 * std::numbers::pi * 3 * part); }, true);
  const Diagnosis diagnosis = diagnose_most(data, {});
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, std::vector<std::string>{"time"});
  DiagnosisOptions options;
  options.without = {"serial_offsets"};
  EXPECT_NE(diagnose_most(data, options).verdict, Verdict::unknown);
}

TEST(SerialOffsets, AStraightDriftStaysOne) {
  const Observations data = with_offsets([](double part) { return 4 * part - 2; });
  EXPECT_TRUE(is_sure_of_a_drift(diagnose_most(data, {})));
}

// Offsets by chance, as large, are no news.
TEST(SerialOffsets, OffsetsByChanceAreNothing) {
  RandomStream random(9);
  std::vector<double> by_movement;
  const Observations data = with_offsets([&](double part) {
    const auto movement = static_cast<std::size_t>(std::lround(part * 40));
    while (by_movement.size() <= movement) by_movement.push_back(random.sign());
    return by_movement[movement];
  });
  EXPECT_EQ(diagnose_most(data, {}).verdict, Verdict::none);
}

}  // namespace
}  // namespace tribench::loop
