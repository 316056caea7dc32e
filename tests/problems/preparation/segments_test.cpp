// SPDX-License-Identifier: MIT
#include "problems/preparation/segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "foundation/random.hpp"

namespace tribench {
namespace {

std::vector<int> one_movement(const std::vector<double>& rows) {
  return std::vector<int>(rows.size(), 0);
}

TEST(Segments, AGapCutsAndAPauseBetweenStrokesDoesToo) {
  std::vector<double> time;
  std::vector<double> v;
  for (int i = 0; i < 3000; ++i) {
    time.push_back(0.002 * i + (i >= 2500 ? 1.0 : 0.0));
    const double t = 0.002 * i;
    v.push_back(t < 1 ? 0.5 : t < 2 ? 0 : t < 3 ? -0.5 : t < 4 ? 0.25 : 0.01);
  }
  const std::vector<int> movement(time.size(), 0);
  const std::vector<RowRange> pieces = pieces_of(time, movement, {});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[1].begin, 2500U);
  const Strokes strokes = strokes_of(time, v, pieces, 0, 8);
  EXPECT_EQ(strokes.rests, 1U);
  EXPECT_EQ(strokes.resting, 500U);
  EXPECT_EQ(strokes.reversals, 1U);
  ASSERT_EQ(strokes.strokes.size(), 4U);  // before and after the rest, the reversal and the gap
  EXPECT_EQ(strokes.strokes[1].begin, 1000U);
  EXPECT_EQ(strokes.strokes[2].begin, 1500U);
}

TEST(Segments, ALimitIsToldFromAPeak) {
  std::vector<double> sine;
  std::vector<double> clipped;
  for (int i = 0; i < 5000; ++i) {
    sine.push_back(std::round(1000 * std::sin(0.01 * i)) / 1000);
    clipped.push_back(std::clamp(sine.back(), -0.8, 0.8));
  }
  for (const char one : clipped_rows(sine)) ASSERT_EQ(one, 0);
  std::size_t found = 0;
  for (const char one : clipped_rows(clipped)) found += one != 0 ? 1 : 0;
  EXPECT_GT(found, 1500U);
}

// Of a noisy torque as many rows are close to its limit as stand on it.
TEST(Segments, ALimitIsFoundThoughFewRowsReachIt) {
  RandomStream random(key_of("limit"));
  std::vector<double> noisy;
  for (int i = 0; i < 12000; ++i) {
    noisy.push_back(std::round(1000 * (20 * std::sin(0.01 * i) + 3 * random.normal())) / 1000);
  }
  for (const char one : clipped_rows(noisy)) ASSERT_EQ(one, 0);
  std::vector<double> clipped;
  for (const double torque : noisy) clipped.push_back(std::clamp(torque, -24.5, 24.5));
  const auto at = std::ranges::count_if(clipped, [](double x) { return std::abs(x) == 24.5; });
  const auto close = std::ranges::count_if(clipped, [](double x) { return std::abs(x) > 23.5; });
  ASSERT_LT(2 * at, close);
  EXPECT_EQ(std::ranges::count(clipped_rows(clipped), 1), at);
}

TEST(Segments, ARepeatedMessageIsToldFromACoarseEncoder) {
  std::vector<double> position;
  std::vector<double> current;
  for (int i = 0; i < 1000; ++i) {
    position.push_back(std::floor(i / 2.0));
    current.push_back(std::sin(12.3 * i));
  }
  for (const char one : repeated_rows(position, current, one_movement(position))) ASSERT_EQ(one, 0);
  for (int i = 400; i < 420; ++i) {
    position[static_cast<std::size_t>(i)] = position[399];
    current[static_cast<std::size_t>(i)] = current[399];
  }
  std::size_t found = 0;
  for (const char one : repeated_rows(position, current, one_movement(position)))
    found += one != 0 ? 1 : 0;
  EXPECT_EQ(found, 20U);
}

// A sensor that has stopped; an axis at rest, whose drive is off, has not, nor has a coarse one.
TEST(Segments, AChannelThatKeepsItsValueWhileTheAxisMovesIsStuck) {
  std::vector<double> position;
  std::vector<double> torque;
  for (int i = 0; i < 2000; ++i) {
    position.push_back(std::min(i, 1500) + i % 2);
    torque.push_back(i < 1800 ? std::sin(12.3 * i) : 0);
  }
  for (const char one : stuck_rows(position, torque, one_movement(position))) ASSERT_EQ(one, 0);
  for (std::size_t i = 401; i < 600; ++i) torque[i] = torque[400];
  const std::vector<char> stuck = stuck_rows(position, torque, one_movement(position));
  for (std::size_t i = 0; i < stuck.size(); ++i) {
    ASSERT_EQ(stuck[i], i > 400 && i < 600 ? 1 : 0) << i;
  }
  for (double& one : torque) one = std::round(one);
  for (const char one : stuck_rows(position, torque, one_movement(position))) ASSERT_EQ(one, 0);
}

// At a count every 20 rows a lost message of 30 hides a count or two: no jump, and yet the motion
// has gone on. An axis at rest whose drive is off repeats its current as well, and its last count
// flickers.
TEST(Segments, ARepeatedMessageIsToldWhereTheAxisCreeps) {
  std::vector<double> position;
  std::vector<double> current;
  for (int i = 0; i < 2000; ++i) {
    position.push_back(i < 1000 ? std::floor(i / 20.0) : 50 + (i / 40) % 2);
    current.push_back(i < 1700 ? std::sin(12.3 * i) : 0);
  }
  for (int i = 401; i < 431; ++i) {
    position[static_cast<std::size_t>(i)] = position[400];
    current[static_cast<std::size_t>(i)] = current[400];
  }
  const std::vector<char> repeated = repeated_rows(position, current, one_movement(position));
  for (std::size_t i = 0; i < repeated.size(); ++i) {
    ASSERT_EQ(repeated[i], i > 400 && i < 431 ? 1 : 0) << i;
  }
}

// A drive that is switched off before a movement ends repeats itself; where the next one in the
// file begins says nothing of that.
TEST(Segments, AMessageIsRepeatedWithinItsMovementAlone) {
  std::vector<double> position;
  std::vector<double> current;
  std::vector<int> movement;
  for (int m = 0; m < 4; ++m) {
    for (int i = 0; i < 300; ++i) {
      position.push_back(10 * m + std::min(i, 280) / 100.0);
      current.push_back(i < 280 ? std::sin(12.3 * (i + m)) : 0);
      movement.push_back(m);
    }
  }
  for (const char one : repeated_rows(position, current, movement)) ASSERT_EQ(one, 0);
}

// Ten rows a second are at the bound: they are regular wherever the clock begins.
TEST(Segments, AStepOfATenthOfASecondIsRegularWhateverTheClocksOrigin) {
  for (const double origin : {0.0, 3.0, 1e3, 1672531200.0}) {
    std::vector<double> time;
    for (int i = 0; i < 200; ++i) time.push_back(origin + 0.1 * i);
    EXPECT_TRUE(is_regular(time, std::vector<int>(time.size(), 0))) << origin;
  }
  std::vector<double> slow;
  for (int i = 0; i < 200; ++i) slow.push_back(0.11 * i);
  EXPECT_FALSE(is_regular(slow, std::vector<int>(slow.size(), 0)));
}

// Windows of 0.05 s over rows of 5 ms: whether they hold ten or eleven is not for rounding to say.
TEST(Segments, ARestIsTheSameWhateverTheClocksOrigin) {
  RandomStream random(3);
  std::vector<double> v;
  for (int i = 0; i < 4000; ++i) {
    v.push_back((i / 200 % 2 == 0 ? 0.5 : 0.0) + 0.002 * random.normal());
  }
  const std::vector<int> movement(v.size(), 0);
  std::vector<std::size_t> resting;
  for (const double origin : {0.0, 0.1, 3.0, 1e3, 1e6}) {
    std::vector<double> time;
    for (std::size_t i = 0; i < v.size(); ++i)
      time.push_back(origin + 0.005 * static_cast<double>(i));
    const Strokes strokes = strokes_of(time, v, pieces_of(time, movement, {}), 0, 8);
    resting.push_back(strokes.resting);
  }
  EXPECT_GT(resting.front(), 1000U);
  for (const std::size_t rows : resting) EXPECT_EQ(rows, resting.front());
}

}  // namespace
}  // namespace tribench
