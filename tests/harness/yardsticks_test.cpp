// SPDX-License-Identifier: MIT
#include "harness/yardsticks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "problems/catalogue.hpp"

namespace tribench {
namespace {

TEST(Yardsticks, AreOrderedAsTheyMustOnTheRowsThatTheLawWasFittedTo) {
  // Judged on its own training rows, the refitted law has the least squares of all three.
  for (const char* name : {"A/j2/no_load", "A/j4/load"}) {
    Problem problem = Catalogue().find(name).make(3);
    problem.test = problem.stages[0].train;
    const Yardsticks found = measure_yardsticks(problem);
    EXPECT_NEAR(found.law, found.ceiling, 1e-12) << name;
    EXPECT_LT(found.refitted, found.law) << name;
    EXPECT_GT(found.truth_refitted, 0) << name;
    EXPECT_LT(found.truth_refitted, found.refitted) << name;
  }
}

TEST(Yardsticks, OfAStagedProblemFitTheShiftToWhatTheFirstStageLeaves) {
  const Problem problem = Catalogue().find("B/j2/no_load").make(3);
  const Yardsticks found = measure_yardsticks(problem);
  EXPECT_NEAR(found.law, found.ceiling, 1e-12);
  // The shift is 2 to 3 N m: without the second stage nothing comes near.
  EXPECT_LT(found.refitted, 1.3 * found.ceiling);
  Problem unadapted = problem;
  unadapted.stages.pop_back();
  EXPECT_GT(measure_yardsticks(unadapted).refitted, 2 * found.ceiling);
}

TEST(Yardsticks, AreMissingWhereNoLawIsKnown) {
  Problem problem = Catalogue().find("A/j2/no_load").make(1);
  problem.stages[0].law.clear();
  problem.test.truth.clear();
  const Yardsticks found = measure_yardsticks(problem);
  EXPECT_TRUE(std::isnan(found.ceiling));
  EXPECT_TRUE(std::isnan(found.law));
  EXPECT_TRUE(std::isnan(found.refitted));
  EXPECT_TRUE(std::isnan(found.truth_refitted));
}

}  // namespace
}  // namespace tribench
