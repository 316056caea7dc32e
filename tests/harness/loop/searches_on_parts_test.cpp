// SPDX-License-Identifier: MIT
#include "harness/loop/searches_on_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reports/record/loop_record.hpp"
#include "tests/harness/loop/judged_planted.hpp"

namespace tribench::loop {
namespace {

// A bump of the friction at one speed, as large as the noise, and one of a quarter of it: both are
// left over, and one of them hangs on a few of the movements.
TEST(SearchesOnParts, WhatIsLeftOverHasAShareAsEffectsHave) {
  const JudgingOptions on_parts{.resample = true};
  const kuka::PlantedCase large{.effects = {{"velocity_bump", 1.0}}};
  EXPECT_TRUE(std::isnan(judge_planted(large, 2).leftover.chosen_share)) << "no parts";
  const JudgedDiagnosis sure = judge_planted(large, 2, on_parts);
  EXPECT_EQ(sure.verdict, Verdict::unknown);
  EXPECT_GE(sure.leftover.chosen_share, 0.9);
  const kuka::PlantedCase faint{.effects = {{"velocity_bump", 0.25}}};
  const JudgedDiagnosis unsure = judge_planted(faint, 41, on_parts);
  EXPECT_EQ(unsure.verdict, Verdict::unknown);
  EXPECT_LT(unsure.leftover.chosen_share, kStableShare);
  EXPECT_GT(unsure.leftover.chosen_share, 0);
}

TEST(SearchesOnParts, WhereNothingIsLeftOverThereIsNoShare) {
  const JudgedDiagnosis diagnosis =
      judge_planted({.effects = {{"load_coulomb", 1.0}}}, 2, {.resample = true});
  EXPECT_EQ(diagnosis.verdict, Verdict::effects);
  EXPECT_GE(diagnosis.effects.at(0).chosen_share, 0.9);
  EXPECT_TRUE(std::isnan(diagnosis.leftover.chosen_share));
}

}  // namespace
}  // namespace tribench::loop
