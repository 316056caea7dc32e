// SPDX-License-Identifier: MIT
#include "harness/instruction_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <thread>

namespace tribench {
namespace {

double work(int turns) {
  double x = 0.5;
  for (int i = 0; i < turns; ++i) x = 3.7 * x * (1 - x);
  return x;
}

double counted(int turns) {
  const InstructionCounter counter;
  const volatile double result = work(turns);
  static_cast<void>(result);
  return counter.count();
}

TEST(InstructionCounter, CountsAlikeWhereTheKernelAllowsItAndElseLeavesTheFigureOut) {
  constexpr int kTurns = 5'000'000;
  const double once = counted(kTurns);
  if (std::isnan(once)) {
    // Every other use must be left out, too: half a figure would be compared with a whole one.
    EXPECT_TRUE(std::isnan(counted(kTurns)));
    GTEST_SKIP() << "this kernel or processor counts no instructions for us";
  }
  std::printf("%.0f instructions\n", once);
  EXPECT_GT(once, 3.0 * kTurns);
  EXPECT_LT(once, 100.0 * kTurns);
  EXPECT_NEAR(counted(kTurns) / once, 1, 1e-3);
  EXPECT_NEAR(counted(2 * kTurns) / once, 2, 1e-2);
  const InstructionCounter with_threads;
  std::thread other([] { work(kTurns); });
  other.join();
  EXPECT_GT(with_threads.count(), 0.9 * once);
}

}  // namespace
}  // namespace tribench
