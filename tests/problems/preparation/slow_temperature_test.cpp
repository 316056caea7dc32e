// SPDX-License-Identifier: MIT
#include "problems/preparation/slow_temperature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {
namespace {

struct WarmingUp {
  std::vector<double> time;
  std::vector<double> temperature;
  std::vector<int> movement;
};

// Movements of 30 s, a pause after each, at 50 rows a second.
WarmingUp warming_up() {
  WarmingUp out;
  for (int m = 0; m < 12; ++m) {
    for (int i = 0; i < 1500; ++i) {
      out.time.push_back(37.5 * m + 0.02 * i);
      out.temperature.push_back(22 + 12 * (1 - std::exp(-out.time.back() / 200)));
      out.movement.push_back(m);
    }
  }
  return out;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(SlowTemperature, LeavesWhatAThermalMassDoes) {
  const WarmingUp log = warming_up();
  const std::vector<double> slow = slow_temperature(log.temperature, log.time, log.movement);
  EXPECT_LT(largest_difference(slow, log.temperature), 0.02);
}

TEST(SlowTemperature, TakesAwayNoise) {
  const WarmingUp log = warming_up();
  RandomStream random(1);
  std::vector<double> read = log.temperature;
  for (double& x : read) x += 0.2 * random.normal();
  EXPECT_LT(largest_difference(slow_temperature(read, log.time, log.movement), log.temperature),
            0.08);
}

TEST(SlowTemperature, TakesAwayStepsOfWholeDegrees) {
  const WarmingUp log = warming_up();
  std::vector<double> read = log.temperature;
  for (double& x : read) x = std::round(x);
  const std::vector<double> slow = slow_temperature(read, log.time, log.movement);
  double before = 0;
  double after = 0;
  // While it warms up by more than a step in the time of a line.
  for (std::size_t i = 0; i < 6000; ++i) {
    before += std::pow(read[i] - log.temperature[i], 2);
    after += std::pow(slow[i] - log.temperature[i], 2);
  }
  EXPECT_LT(after, 0.5 * before);
}

TEST(SlowTemperature, KeepsWhatIsToldOnceAMovement) {
  const WarmingUp log = warming_up();
  std::vector<double> read(log.time.size());
  for (std::size_t i = 0; i < read.size(); ++i) read[i] = 22.1 + 0.7 * log.movement[i];
  EXPECT_EQ(slow_temperature(read, log.time, log.movement), read);
}

TEST(SlowTemperature, KeepsTheReadingsOfAMovementWhoseTimeRunsBack) {
  const std::vector<double> read = {20, 21, 20, 22, 20, 23};
  const std::vector<double> time = {0, 1, 0.5, 0, 1, 2};
  const std::vector<double> slow = slow_temperature(read, time, std::vector<int>{0, 0, 0, 1, 1, 1});
  EXPECT_EQ(std::vector<double>(slow.begin(), slow.begin() + 3), (std::vector<double>{20, 21, 20}));
  EXPECT_NEAR(slow[3], 21.0 + 1.0 / 6, 1e-12);
  EXPECT_NEAR(slow[5], 22.0 + 1.0 / 6, 1e-12);
}

// Movements of 2 s at 25 rows a second, read in half degrees.
WarmingUp short_movements() {
  WarmingUp out;
  for (int m = 0; m < 120; ++m) {
    for (int i = 0; i < 50; ++i) {
      out.time.push_back(2.5 * m + 0.04 * i);
      out.temperature.push_back(std::round(2 * (30 + 6 * std::sin(out.time.back() / 40))) / 2);
      out.movement.push_back(m);
    }
  }
  return out;
}

double rate_error(const WarmingUp& log, EarlierMovements earlier) {
  const std::vector<double> rate =
      temperature_rate(log.temperature, log.time, log.movement, earlier);
  double squares = 0;
  for (std::size_t i = 0; i < rate.size(); ++i) {
    squares += std::pow(rate[i] - 6.0 / 40 * std::cos(log.time[i] / 40), 2);
  }
  return std::sqrt(squares / static_cast<double>(rate.size()));
}

TEST(TemperatureRate, IsToldBetterWithTheMovementsBefore) {
  const WarmingUp log = short_movements();
  const double with_those_before = rate_error(log, EarlierMovements::remembered);
  EXPECT_LT(with_those_before, 0.25 * 6.0 / 40);
  EXPECT_LT(with_those_before, 0.4 * rate_error(log, EarlierMovements::forgotten));
}

TEST(TemperatureRate, OfAMovementIsNotChangedByWhatComesAfterIt) {
  const WarmingUp log = short_movements();
  const auto rate = [&](std::size_t rows) {
    return temperature_rate(std::span(log.temperature).first(rows), std::span(log.time).first(rows),
                            std::span(log.movement).first(rows), EarlierMovements::remembered);
  };
  std::vector<double> all = rate(log.time.size());
  all.resize(3000);
  EXPECT_EQ(rate(3000), all);
}

// Of movements that each have their own time none is before another; within one there is no rate
// where its time runs back or stands still.
TEST(TemperatureRate, GoesBackAsFarAsTimeRunsOn) {
  const std::vector<double> read = {20, 21, 40, 42, 30, 31, 32, 50};
  const std::vector<double> time = {7, 8, 0, 1, 1, 0, 2, 3};
  const std::vector<double> rate = temperature_rate(
      read, time, std::vector<int>{0, 0, 1, 1, 2, 2, 2, 3}, EarlierMovements::remembered);
  EXPECT_EQ(std::vector<double>(rate.begin(), rate.begin() + 7),
            (std::vector<double>{1, 1, 2, 2, 0, 0, 0}));
  EXPECT_EQ(temperature_rate(read, time, std::vector<int>{0, 0, 1, 1, 2, 2, 2, 3},
                             EarlierMovements::forgotten)[7],
            0);
}

}  // namespace
}  // namespace tribench::loop
