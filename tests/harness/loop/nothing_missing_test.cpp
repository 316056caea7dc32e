// SPDX-License-Identifier: MIT
#include "harness/loop/nothing_missing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "foundation/random.hpp"
#include "reports/record/loop_record.hpp"

namespace tribench::loop {
namespace {

// Of two candidates, the second takes `share` of the base's loss on movements left out.
JudgedDiagnosis names_nothing(double share) {
  JudgedDiagnosis whole;
  whole.error.mae_after = whole.error.attainable = 1;
  whole.candidates.resize(2);
  whole.candidates[0].family = "drift";
  whole.candidates[1].family = "stribeck";
  whole.candidates[1].gain_share = share;
  return whole;
}

TEST(NothingMissing, IsNotSaidWhereAnEffectThatFewMovementsCarryLeavesMuchLess) {
  JudgedDiagnosis whole = names_nothing(0.64);
  doubt_nothing_missing(whole, {});
  EXPECT_EQ(whole.verdict, Verdict::cannot_tell);
  EXPECT_THAT(whole.needed, ::testing::ElementsAre(
                                ::testing::HasSubstr("'stribeck' would leave 40 % less error")));
}

TEST(NothingMissing, IsNotSaidWhereASmoothFunctionLeavesMuchLess) {
  JudgedDiagnosis whole = names_nothing(0);
  whole.error.attainable = 0.8;
  doubt_nothing_missing(whole, {});
  EXPECT_EQ(whole.verdict, Verdict::cannot_tell);
  EXPECT_THAT(whole.needed, ::testing::ElementsAre(::testing::HasSubstr("leaves 20 % less")));
}

TEST(NothingMissing, IsSaidWhereNeitherDoes) {
  JudgedDiagnosis whole = names_nothing(0.05);
  whole.error.attainable = 0.98;
  doubt_nothing_missing(whole, {});
  EXPECT_EQ(whole.verdict, Verdict::none);
}

// A dozen movements with offsets that no signal tells.
TEST(NothingMissing, IsNotSaidOfAFewMovementsThatDifferFromOneAnother) {
  const auto judged = [](double offset) {
    RandomStream random(7);
    Dataset data;
    data.channels = {{"time", "s", Role::time, {}},
                     {"v", "rad/s", Role::velocity, {}},
                     {"tau_f", "N m", Role::friction_torque, {}}};
    for (int m = 0; m < 12; ++m) {
      data.movement_names.push_back(std::to_string(m));
      const double way = m % 2 == 0 ? 1 : -1;
      const double own = offset * random.normal();
      for (int i = 0; i < 700; ++i) {
        const double v = way * (0.2 + 0.8 * (i % 350) / 350.0);
        data.movement.push_back(m);
        data.channels[0].values.push_back(100 * m + 0.01 * i);
        data.channels[1].values.push_back(v);
        data.channels[2].values.push_back(8 * way + 14 * v + own + 0.15 * random.normal());
      }
    }
    return diagnose_and_judge(observe(data), coulomb_viscous_base, {});
  };
  const JudgedDiagnosis differ = judged(0.7);
  EXPECT_EQ(differ.verdict, Verdict::cannot_tell);
  EXPECT_THAT(differ.needed, ::testing::ElementsAre(::testing::HasSubstr("12 that differ")));
  EXPECT_EQ(judged(0).verdict, Verdict::none);
}

}  // namespace
}  // namespace tribench::loop
