// SPDX-License-Identifier: MIT
#include "harness/loop/nothing_missing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/record/loop_record.hpp"
#include "tests/support/movements_with_offsets.hpp"

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
    return diagnose_and_judge(observe(testing::movements_with_offsets(12, offset, 7)),
                              coulomb_viscous_base, {});
  };
  const JudgedDiagnosis differ = judged(0.7);
  EXPECT_EQ(differ.verdict, Verdict::cannot_tell);
  EXPECT_THAT(differ.needed, ::testing::ElementsAre(::testing::HasSubstr("12 that differ")));
  EXPECT_EQ(judged(0).verdict, Verdict::none);
}

}  // namespace
}  // namespace tribench::loop
