// SPDX-License-Identifier: MIT
#include "harness/study/reference_study.hpp"

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"

namespace tribench {
namespace {

TEST(ReferenceStudy, PublishedErrorsOfEmpsComeOutWithinATenthOfAPercent) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  const std::vector<ReferenceFigure> figures = run_reference_study(data);
  ASSERT_EQ(figures.size(), 3U);
  for (const ReferenceFigure& figure : figures) {
    EXPECT_NEAR(figure.ours, figure.published, 0.1) << figure.problem << " " << figure.model;
    EXPECT_TRUE(figure.within);
  }
}

}  // namespace
}  // namespace tribench
