// SPDX-License-Identifier: MIT
//
// Two effects that together draw what one draws alone.
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

// Swings about one place and another, over a torque that depends on the place; no row is far from
// its middle.
template <class Torque>
Observations swings_over(const Torque& torque_of, std::uint64_t seed) {
  constexpr int kRows = 60;
  RandomStream random(seed);
  std::string text = "movement,q,v,friction_torque_Nm\n";
  for (int m = 0; m < 40; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double reach = 0.8 * random.uniform(0.3, 1);
    const double middle = random.uniform(-0.4, 0.4);
    const double offset = 0.2 * random.normal();
    for (int i = 1; i < kRows; ++i) {
      const double phase = std::numbers::pi * i / kRows;
      const double q = middle - s * reach * std::cos(phase);
      const double v = s * reach * w * std::sin(phase);
      const double torque = 4 * s + 6 * v + torque_of(q) + offset + 0.25 * random.normal();
      text += fmt::format("{},{},{},{}\n", m, q, v, torque);
    }
  }
  return observe(parse_csv(text, "swings.csv").data);
}

BaseModel symmetric(const Observations& data) { return formula_base(data, "4*sgn_v + 6*v"); }

// At first a mass tells more than a spring that is slack elsewhere, whose zero is an effect of its
// own; what the mass leaves of the straight line a ripple of the joint tells.
TEST(CancellingEffects, GiveWayToFewerThatTellAsMuch) {
  const auto spring = [](double q) { return 4 * (q - 0.1); };
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Diagnosis diagnosis = diagnose(swings_over(spring, seed), symmetric, {});
    EXPECT_THAT(families(diagnosis), ::testing::ElementsAre("spring", "asymmetry")) << seed;
  }
}

TEST(CancellingEffects, StayWhereFewerTellLess) {
  const auto mass_and_ripple = [](double q) {
    return 4 * std::sin(q + 0.25) + std::cos(2 * q + 0.4);
  };
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Diagnosis diagnosis = diagnose(swings_over(mass_and_ripple, seed), symmetric, {});
    EXPECT_THAT(families(diagnosis), ::testing::ElementsAre("payload", "output_ripple")) << seed;
    ASSERT_FALSE(diagnosis.effects.empty());
    EXPECT_TRUE(diagnosis.effects[0].told_by_others) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
