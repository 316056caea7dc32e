// SPDX-License-Identifier: MIT
//
// Offsets of movements that are like their neighbours', though no effect says why.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "tests/algorithms/diagnosis/half_sines.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

// 40 movements without an effect but an offset of each: of the part of the campaign that has gone
// by.
Observations with_offsets(const std::function<double(double)>& offset) {
  Observations data =
      half_sines_over({.movements = 40, .rows = 80, .seed = 3}, [](double) { return 0; });
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] += kHalfSinesNoise * offset(data.movement[i] / 40.);
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
