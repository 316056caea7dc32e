// SPDX-License-Identifier: MIT
#include "problems/preparation/steady_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "foundation/random.hpp"

namespace tribench {
namespace {

constexpr double kPeriod = 0.004;
constexpr std::size_t kRows = 4000;

struct Stamped {
  std::vector<double> sampled;  // when the rows were made
  std::vector<double> stamps;
};

// Every message is late by itself; some are lost; the clock gains 50 ppm.
Stamped late_stamps(double jitter, double lost) {
  RandomStream random(71);
  Stamped out;
  for (std::size_t i = 0; i < kRows; ++i) {
    const double late = -jitter * kPeriod * std::log(random.uniform(1e-9, 1));
    if (random.chance(lost)) continue;
    out.sampled.push_back(kPeriod * static_cast<double>(i) * (1 + 5e-5));
    out.stamps.push_back(out.sampled.back() + late);
  }
  return out;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double mean = 0;  // when a message leaves nobody knows
  for (std::size_t i = 0; i < a.size(); ++i) mean += (a[i] - b[i]) / static_cast<double>(a.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i] - mean) * (a[i] - b[i] - mean);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(SteadyClock, TheInstantsBehindLateAndLostMessagesAreFound) {
  for (const double lost : {0.0, 0.05}) {
    const Stamped rows = late_stamps(0.1, lost);
    const std::vector<RowRange> whole = {{0, rows.stamps.size()}};
    const std::optional<SteadyClock> clock = steady_clock(rows.stamps, whole);
    ASSERT_TRUE(clock);
    EXPECT_NEAR(clock->jitter, 0.1 * kPeriod, 0.01 * kPeriod);
    EXPECT_LT(distance(clock->time, rows.sampled), 0.02 * kPeriod);
    EXPECT_NEAR(distance(rows.stamps, rows.sampled), 0.1 * kPeriod, 0.01 * kPeriod);
  }
}

// Stamps that are early as often as late, so far that some round to another sample: beside a lost
// message a wrong count would shift all rows from there to the next one.
TEST(SteadyClock, StampsThatRoundToAnotherSampleAreCountedWithTheirNeighbours) {
  for (const double lost : {0.0, 0.0002, 0.002, 0.01}) {
    RandomStream random(73);
    Stamped rows;
    for (std::size_t i = 0; i < 70'000; ++i) {
      const double off = 0.2 * kPeriod * random.normal();
      if (random.chance(lost)) continue;
      const double stamp = kPeriod * static_cast<double>(i) + off;
      if (!rows.stamps.empty() && stamp <= rows.stamps.back()) continue;
      rows.sampled.push_back(kPeriod * static_cast<double>(i));
      rows.stamps.push_back(stamp);
    }
    const std::vector<RowRange> whole = {{0, rows.stamps.size()}};
    const std::optional<SteadyClock> clock = steady_clock(rows.stamps, whole);
    ASSERT_TRUE(clock) << lost;
    EXPECT_NEAR(clock->jitter, 0.2 * kPeriod, 0.01 * kPeriod) << lost;
    EXPECT_LT(distance(clock->time, rows.sampled), 0.05 * kPeriod) << lost;
  }
}

TEST(SteadyClock, EvenStampsAndRowsWithoutABeatHaveNone) {
  std::vector<double> even;
  std::vector<double> uneven;
  RandomStream random(72);
  for (std::size_t i = 0; i < kRows; ++i) {
    even.push_back(kPeriod * static_cast<double>(i));
    uneven.push_back((i == 0 ? 0 : uneven.back()) + kPeriod * random.uniform(0.2, 3));
  }
  const std::vector<RowRange> whole = {{0, kRows}};
  EXPECT_FALSE(steady_clock(even, whole));
  EXPECT_FALSE(steady_clock(uneven, whole));
}

}  // namespace
}  // namespace tribench
