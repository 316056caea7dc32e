// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "harness/study/log_study.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

// Seeds that nothing was settled on. Bounds are what was seen on other seeds (15 and 14), less two
// of twenty.
TEST(LogStudy, RawLogsTellWhatCleanTablesTell) {
  LogStudyOptions options;
  options.logs = 20;
  options.first_seed = 1001;
  const LogStudy study = run_log_study(testing::program().string(), options);
  const LogFigure& told = study.figures.at(1);
  const LogFigure& bare = study.figures.at(2);
  EXPECT_EQ(told.read, told.logs);
  EXPECT_EQ(bare.read, bare.logs);
  EXPECT_EQ(told.misread + bare.misread, 0U);
  EXPECT_GE(told.right, 15U);
  EXPECT_GE(bare.right, 11U);
}

}  // namespace
}  // namespace tribench
