// SPDX-License-Identifier: MIT
#include "algorithms/budget.hpp"

#include <gtest/gtest.h>

namespace tribench {
namespace {

void burn(double seconds) {
  const double start = process_cpu_seconds();
  while (process_cpu_seconds() - start < seconds) {
  }
}

TEST(Budget, LooksAtTheClockWhenAskedWithoutSpending) {
  Budget budget({.cpu_seconds = 0.02});
  EXPECT_TRUE(budget.in_time());
  burn(0.03);
  EXPECT_FALSE(budget.out_of_time());  // nobody has looked
  EXPECT_FALSE(budget.in_time());
  EXPECT_TRUE(budget.out_of_time());
  EXPECT_EQ(budget.spent(), 0U);
}

TEST(Budget, APartOfTheSecondsEndsAloneAndIsRemembered) {
  Budget budget({.evaluations = 1000, .cpu_seconds = 10});
  Budget part = budget.share(400, 0.002);
  burn(0.03);
  EXPECT_FALSE(part.spend(1));
  EXPECT_TRUE(part.out_of_time());
  budget.settle(part);
  EXPECT_FALSE(budget.out_of_time());
  EXPECT_FALSE(budget.exhausted());
  EXPECT_TRUE(budget.spend(1));
  EXPECT_TRUE(budget.was_cut_by_clock());  // not reproducible by evaluations alone
}

TEST(Budget, ASharesClockIsTheWholesWithoutAPartOfTheSeconds) {
  Budget budget({.cpu_seconds = 0.01});
  Budget part = budget.share(400);
  burn(0.02);
  EXPECT_FALSE(part.spend(1));
  EXPECT_TRUE(budget.out_of_time());
}

TEST(Budget, WithoutALimitNoPartHasOne) {
  Budget budget({.evaluations = 1000});
  Budget part = budget.share(400, 0.0);
  EXPECT_TRUE(part.spend(400));
  EXPECT_FALSE(part.spend(1));
  EXPECT_FALSE(part.out_of_time());
  budget.settle(part);
  EXPECT_EQ(budget.spent(), 400U);
}

}  // namespace
}  // namespace tribench
