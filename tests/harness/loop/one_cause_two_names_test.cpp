// SPDX-License-Identifier: MIT
//
// A joint that runs in while it warms up: friction falls with the campaign's time as with the
// temperature, and searches on parts of the movements call it now by the one name, now by the
// other.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "harness/loop/judged_diagnosis.hpp"
#include "problems/reading/csv.hpp"

namespace tribench::loop {
namespace {

constexpr double kStep = 0.02;
constexpr double kRunIn = 60;  // s
constexpr double kNoise = 0.25;

// Half sines one way and the other. warming: how many seconds the temperature takes.
Observations running_in(std::uint64_t seed, double warming) {
  RandomStream random(seed);
  std::string text = "movement,time_s,q,v,temperature_degC,friction_torque_Nm\n";
  double begin = 0;
  for (int m = 0; m < 24; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double reach = random.uniform(0.7, 1.2);
    const double seconds = std::numbers::pi / w;
    for (double t = kStep; t < seconds; t += kStep) {
      const double v = s * reach * w * std::sin(w * t);
      const double coulomb = 4 + 0.5 * std::exp(-(begin + t) / kRunIn);
      text += fmt::format("{},{},{},{},{},{}\n", m, begin + t, -s * reach * std::cos(w * t), v,
                          25 + 5 * (1 - std::exp(-(begin + t) / warming)),
                          s * coulomb + 6 * v + kNoise * random.normal());
    }
    begin += seconds;
  }
  return observe(parse_csv(text, "running_in.csv").data);
}

TEST(OneCauseOfTwoNames, IsNamedWithTheOtherAsItsAlias) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const double warming : {50.0, 70.0}) {
      const JudgedDiagnosis diagnosis =
          diagnose_and_judge(running_in(seed, warming), coulomb_viscous_base, {});
      const std::string which = fmt::format("seed {}, {} s", seed, warming);
      EXPECT_EQ(diagnosis.verdict, Verdict::effects) << which;
      ASSERT_EQ(diagnosis.effects.size(), 1U) << which;
      const EffectFinding& effect = diagnosis.effects[0];
      ASSERT_THAT(effect.family, ::testing::AnyOf("drift", "temperature")) << which;
      EXPECT_THAT(effect.aliases,
                  ::testing::Contains(::testing::Field(
                      &AliasFinding::family, effect.family == "drift" ? "temperature" : "drift")))
          << which;
      EXPECT_GE(effect.chosen_share, 0.9) << which;
      // The mean magnitude of normal noise is 0.8 of its standard deviation.
      EXPECT_LT(diagnosis.error.mae_after, 1.05 * 0.8 * kNoise) << which;
    }
  }
}

}  // namespace
}  // namespace tribench::loop
