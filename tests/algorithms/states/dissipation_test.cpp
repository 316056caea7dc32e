// SPDX-License-Identifier: MIT
#include "algorithms/states/dissipation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tribench {
namespace {

using ::testing::HasSubstr;

struct Claim {
  StatefulFormula formula;
  NamedBox box;

  Claim(const std::string& text, const std::string& ranges) : box(parse_box(ranges)) {
    formula = parse_stateful_over(text, box);
  }
  DissipationResult decide() const { return prove_dissipation(formula, box.ranges, 0); }
};

// Fc = 10, Fs = 15: s2 >= s1 / 2 is the condition at every speed.
std::string lugre(double s1, double s2) {
  return "z = lugre(v, sliding=0.001, breakaway=0.0015, stribeck_velocity=0.01); 10000*z + " +
         std::to_string(s1) + "*(v - abs(v)*z/(0.001 + 0.0005*exp(-(v/0.01)^2))) + " +
         std::to_string(s2) + "*v";
}

TEST(Dissipation, LuGreIsProvedWhereItsConditionHolds) {
  for (const double s2 : {1000.001, 1500.0}) {
    EXPECT_EQ(Claim(lugre(2000, s2), "v=-2:2").decide().verdict, Verdict::proved_free) << s2;
  }
}

TEST(Dissipation, LuGreIsRefutedByACycleWhereItIsBroken) {
  const Claim claim(lugre(2000, 100), "v=-2:2");
  const DissipationResult result = claim.decide();
  ASSERT_EQ(result.verdict, Verdict::refuted);
  EXPECT_LT(result.work, 0);
  EXPECT_THAT(work_cycle_json(result, "v"), HasSubstr("{\"cycle\":[{\"v\":"));
  // The cycle again, from the equations, by small Euler steps: energy is won each time round.
  double z = 0;
  double work = 0;
  for (int round = 0; round < 12; ++round) {
    work = 0;
    for (const WorkLeg& leg : result.cycle) {
      constexpr int kSteps = 20000;
      const double h = leg.seconds / kSteps;
      const double v = leg.velocity;
      const double g = 0.001 + 0.0005 * std::exp(-(v / 0.01) * (v / 0.01));
      for (int k = 0; k < kSteps; ++k) {
        const double rate = v - std::abs(v) * z / g;
        work += (10000 * z + 2000 * rate + 100 * v) * v * h;
        z += rate * h;
      }
    }
  }
  EXPECT_LT(work, 0);
  EXPECT_NEAR(work, result.work, 0.05 * std::abs(result.work));
}

// Where the box reaches far beyond the Stribeck velocity, the bristles are still bent at creep.
TEST(Dissipation, LuGreIsRefutedInAWideBoxToo) {
  const char* law =
      "z = lugre(v, sliding=0.0004, breakaway=0.0006, stribeck_velocity=0.02); 12000*z + "
      "20*(v - abs(v)*z/(0.0004 + 0.0002*exp(-(v/0.02)^2))) + ";
  EXPECT_EQ(Claim(law + std::string("3.1*v"), "v=-50:50").decide().verdict, Verdict::refuted);
  EXPECT_EQ(Claim(law + std::string("3.1*v"), "v=-10:10").decide().verdict, Verdict::refuted);
  EXPECT_EQ(Claim(law + std::string("6*v"), "v=-50:50").decide().verdict, Verdict::refuted);
  EXPECT_EQ(Claim(law + std::string("10.1*v"), "v=-50:50").decide().verdict, Verdict::proved_free);
}

// The box decides: where the joint stays slow, the same damping takes nothing back.
TEST(Dissipation, ASmallBoxNeedsLess) {
  EXPECT_EQ(Claim(lugre(2000, 600), "v=-2:2").decide().verdict, Verdict::refuted);
  EXPECT_EQ(Claim(lugre(2000, 600), "v=-0.001:0.001").decide().verdict, Verdict::proved_free);
}

TEST(Dissipation, BristlesOfOtherKindsStoreAndSlide) {
  EXPECT_EQ(Claim("z = dahl(v, sliding=0.001); 5000*z + 3*v", "v=-1:1").decide().verdict,
            Verdict::proved_free);
  EXPECT_EQ(Claim("z = dahl(v, sliding=0.001); 5000*z - 400*abs(z) + 3*v - 2*abs(v)", "v=-1:1")
                .decide()
                .verdict,
            Verdict::proved_free);
  EXPECT_EQ(Claim("a = slip(v, limit=0.001); b = slip(v, limit=0.003); 100*a + 70*b", "v=-1:1")
                .decide()
                .verdict,
            Verdict::proved_free);
  EXPECT_EQ(Claim("z = dahl(v, sliding=0.001); 3*v - 5000*z", "v=-1:1").decide().verdict,
            Verdict::refuted);
}

TEST(Dissipation, AForceThatFollowsLateMayGiveEnergyBack) {
  EXPECT_EQ(Claim("w = lag(v, time_constant=0.1); 5*v + 4*w", "v=-1:1").decide().verdict,
            Verdict::undecided);  // it stores, but not as a bristle
  EXPECT_EQ(Claim("w = lag(v, time_constant=0.1); 5*v - 9*w", "v=-1:1").decide().verdict,
            Verdict::refuted);
}

}  // namespace
}  // namespace tribench
