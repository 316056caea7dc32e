// SPDX-License-Identifier: MIT
#include "algorithms/inference/noise_by_speed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "foundation/order_statistics.hpp"

namespace tribench::loop {
namespace {

using ::testing::Each;

constexpr std::size_t kGroups = 8;
constexpr std::size_t kRowsEach = 10;

// Eighty rows of speeds 0 to 79, given out of order.
std::vector<double> speeds() {
  std::vector<double> all;
  for (std::size_t i = 0; i < kGroups * kRowsEach; ++i)
    all.push_back(static_cast<double>(i * 7 % 80));
  return all;
}

// Of the same magnitude in each group of ten speeds, with signs that alternate: 1 / 1.4826 of it is
// the standard deviation that the group's median says.
std::vector<double> deviations(const std::vector<double>& levels) {
  std::vector<double> all;
  double sign = 1;
  for (const double speed : speeds()) {
    all.push_back(sign * levels[static_cast<std::size_t>(speed) / kRowsEach] / kMadToSd);
    sign = -sign;
  }
  return all;
}

TEST(NoiseBySpeed, IsTheSameEverywhereWithoutSpeedsOrWithFewRows) {
  const std::vector<double> rows(80, 1.0);
  EXPECT_THAT(NoiseBySpeed({}, rows, 0.3).units(), Each(0.3));
  const std::vector<double> speed = speeds();
  const std::vector<double> noise = deviations({1, 2, 3, 4, 5, 6, 7, 8});
  const auto first = [&](std::size_t n) {
    return NoiseBySpeed(std::span(speed).first(n), std::span(noise).first(n), 0.3).units();
  };
  EXPECT_THAT(first(31), Each(0.3));
  EXPECT_THAT(first(32), ::testing::Contains(::testing::Not(0.3)));
  EXPECT_EQ(NoiseBySpeed({}, rows, 0.3).variance({5, 1}, 0.1, std::vector<RowRange>{{0, 80}}), 0);
}

// The logarithm runs straight from one group's middle to the next and, beyond the outermost, on by
// half a group.
TEST(NoiseBySpeed, RunsStraightBetweenTheMiddlesOfItsGroups) {
  const std::vector<double> levels = {1, 2, 4, 8, 4, 2, 1, 0.5};
  const std::vector<double> speed = speeds();
  const std::vector<double> units = NoiseBySpeed(speed, deviations(levels), 2).units();
  for (std::size_t i = 0; i < speed.size(); ++i) {
    // A group's middle is its sixth speed.
    const double place = std::clamp((speed[i] - 5) / 10, -0.5, 7.5);
    const auto left = static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, 6.0));
    const double part = place - static_cast<double>(left);
    const double log = (1 - part) * std::log(levels[left]) + part * std::log(levels[left + 1]);
    EXPECT_NEAR(units[i], std::exp(log), 1e-9) << speed[i];
  }
}

// One speed throughout: its noise is that of the rows, not a division by a width of 0.
TEST(NoiseBySpeed, OfOneSpeedIsAsWideAsItsRows) {
  const std::vector<double> speed(80, 3.0);
  const std::vector<double> noise(80, 2 / kMadToSd);
  for (const double unit : NoiseBySpeed(speed, noise, 1).units()) EXPECT_NEAR(unit, 2, 1e-9);
  // Where rows of it differ, it is as wide as some of them.
  std::vector<double> mixed = noise;
  std::fill(mixed.begin(), mixed.begin() + 10, 1 / kMadToSd);
  for (const double unit : NoiseBySpeed(speed, mixed, 1).units()) {
    EXPECT_GE(unit, 1 - 1e-9);
    EXPECT_LE(unit, 2 + 1e-9);
  }
}

TEST(NoiseBySpeed, IsRefinedByWhatInnovationsSay) {
  NoiseBySpeed noise(speeds(), deviations({1, 1, 1, 1, 1, 1, 1, 1}), 1);
  // Three times as wide as was thought above a speed of 40, and nothing but zeros below.
  std::vector<double> innovation;
  double sign = 1;
  for (const double speed : speeds()) {
    innovation.push_back(speed < 40 ? 0 : sign * 3);
    sign = -sign;
  }
  const StudentLaw law{40, 1};
  noise.refine(innovation, law);
  const std::vector<double> units = noise.units();
  const std::vector<double> speed = speeds();
  const double level = level_of(std::vector<double>{3, -3}, law, 1, kLevelIterations);
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (speed[i] < 35) EXPECT_NEAR(units[i], kLeastLevel, 1e-9) << speed[i];
    if (speed[i] > 45) EXPECT_NEAR(units[i], level, 1e-9) << speed[i];
  }
}

// What a group's own rows leave open, and what its movements do: of n rows in k movements alike a
// share 1 / k of how far movements are apart.
TEST(NoiseBySpeed, IsKnownAsWellAsItsRowsAndMovementsTellIt) {
  const StudentLaw law{5, 1};
  // Rows in order of speed: each group is a movement of its own, or half of one.
  std::vector<double> speed;
  for (std::size_t i = 0; i < 80; ++i) speed.push_back(static_cast<double>(i));
  const NoiseBySpeed noise(speed, std::vector<double>(80, 1.0), 1);
  std::vector<RowRange> movements;
  for (std::size_t g = 0; g < kGroups; ++g) movements.push_back({10 * g, 10 * g + 10});
  EXPECT_NEAR(noise.variance(law, 0.2, movements), law.variance_of_log_level(10) + 0.2, 1e-12);
  std::vector<RowRange> halves;
  for (std::size_t h = 0; h < 2 * kGroups; ++h) halves.push_back({5 * h, 5 * h + 5});
  EXPECT_NEAR(noise.variance(law, 0.2, halves), law.variance_of_log_level(10) + 0.1, 1e-12);
}

}  // namespace
}  // namespace tribench::loop
