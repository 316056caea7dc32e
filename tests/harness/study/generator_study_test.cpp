// SPDX-License-Identifier: MIT
#include "harness/study/generator_study.hpp"

#include <gtest/gtest.h>

namespace tribench {
namespace {

TEST(GeneratorStudy, EveryFigureOfTheSpecificationComesOutWithinTenPercentOverTenSeeds) {
  const std::vector<GeneratorFigure> figures = run_generator_study(10);
  ASSERT_EQ(figures.size(), 26U);
  for (const GeneratorFigure& figure : figures) {
    EXPECT_NEAR(figure.mean, figure.expected, 0.10 * figure.expected)
        << "joint " << figure.joint << ", " << figure.name;
    EXPECT_TRUE(figure.within);
    EXPECT_GT(figure.spread, 0);
  }
}

TEST(GeneratorStudy, IsTheSameEveryTime) {
  const std::vector<GeneratorFigure> first = run_generator_study(1);
  const std::vector<GeneratorFigure> second = run_generator_study(1);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].mean, second[i].mean);
    EXPECT_EQ(first[i].spread, 0);
  }
}

}  // namespace
}  // namespace tribench
