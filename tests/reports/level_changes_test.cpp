// SPDX-License-Identifier: MIT
#include "reports/level_changes.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "foundation/random.hpp"

namespace tribench {
namespace {

using ::testing::IsEmpty;

TEST(LevelChanges, AreFoundWhereTheyArePlanted) {
  RandomStream random(key_of("levels"));
  std::vector<double> values;
  for (int i = 0; i < 300; ++i) {
    values.push_back(0.02 * random.normal() + (i >= 120 ? 0.1 : 0) - (i >= 250 ? 0.06 : 0));
  }
  const auto changes = find_level_changes(values, std::vector<double>(values.size(), 20.0));
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_NEAR(static_cast<double>(changes[0].at), 120, 1);
  EXPECT_NEAR(changes[0].after - changes[0].before, 0.1, 0.01);
  EXPECT_NEAR(static_cast<double>(changes[1].at), 250, 3);
}

TEST(LevelChanges, AreNotSeenInNoiseNorInASingleOddNight) {
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    RandomStream random(key_of(fmt::format("noise {}", trial)));
    std::vector<double> values;
    for (int i = 0; i < 365; ++i) values.push_back(random.normal());
    found += find_level_changes(values, std::vector<double>(365, 1.0)).empty() ? 0 : 1;
  }
  EXPECT_LE(found, 2);
  std::vector<double> spike(50, 1.0);
  spike[25] = 1.3;
  EXPECT_THAT(find_level_changes(spike, std::vector<double>(50, 1.0), 0.1), IsEmpty());
}

TEST(LevelChanges, AreNotSeenInNoiseThatTheWeightsTell) {
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    RandomStream random(key_of(fmt::format("unequal {}", trial)));
    std::vector<double> values;
    std::vector<double> weights;
    for (int i = 0; i < 365; ++i) {
      const double spread = std::exp(1.5 * random.normal());
      values.push_back(spread * random.normal());
      weights.push_back(1 / (spread * spread));
    }
    found += find_level_changes(values, weights).empty() ? 0 : 1;
  }
  EXPECT_LE(found, 2);
}

}  // namespace
}  // namespace tribench
