// SPDX-License-Identifier: MIT
#include "problems/preparation/slow_temperature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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

}  // namespace
}  // namespace tribench::loop
