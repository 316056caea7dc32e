// SPDX-License-Identifier: MIT
#include "harness/study/smoother_study.hpp"

#include <gtest/gtest.h>

namespace tribench {
namespace {

// What docs/first_log.md says of the table, on one of its encoders and on runs of other seeds.
TEST(SmootherStudy, WhatTheDataChooseIsBetterThanWidthsThatKnowTheTruth) {
  SmootherStudyOptions options;
  options.bits = {12, 16};
  options.rates_hz = {250};
  options.runs = 1;
  options.seconds = 20;
  options.first_seed = 77;
  const std::vector<SmootherFigure> figures = run_smoother_study(options);
  ASSERT_EQ(figures.size(), 2U);
  const SmootherFigure& fine = figures[1];
  EXPECT_LT(fine.kalman.velocity, fine.savitzky_golay.velocity);
  EXPECT_LT(fine.kalman.velocity, fine.spline.velocity);
  EXPECT_LT(fine.kalman.acceleration, fine.savitzky_golay.acceleration);
  for (const SmootherFigure& figure : figures) {
    EXPECT_LE(figure.spline.velocity, figure.validated_spline.velocity);
    EXPECT_LT(figure.kalman.velocity, 1.5 * figure.spline.velocity) << figure.bits;
  }
  // A count sixteen times as fine tells the velocity better, whoever derives it.
  EXPECT_LT(fine.kalman.velocity, figures[0].kalman.velocity);
  EXPECT_LT(fine.savitzky_golay.velocity, figures[0].savitzky_golay.velocity);
}

}  // namespace
}  // namespace tribench
