// SPDX-License-Identifier: MIT
#include "foundation/order_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tribench {
namespace {

TEST(OrderStatistics, MediansOfEvenCountsAreTheMiddleOrTheUpperValue) {
  const std::vector<double> values = {4, 1, 3, 2};
  EXPECT_EQ(median(values), 2.5);
  EXPECT_EQ(upper_median(values), 3);
  EXPECT_EQ(upper_median_magnitude({-4, 1, -3, 2}), 3);
  EXPECT_EQ(upper_median({}), 0);
}

TEST(OrderStatistics, QuantilesInterpolateAndLeaveNanOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(quantile(std::vector<double>{nan, 0, 10}, 0.25), 2.5);
  EXPECT_TRUE(std::isnan(median(std::vector<double>{nan})));
}

}  // namespace
}  // namespace tribench
