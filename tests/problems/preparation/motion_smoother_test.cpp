// SPDX-License-Identifier: MIT
#include "problems/preparation/motion_smoother.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/random.hpp"
#include "tests/problems/preparation/raw_log.hpp"

namespace tribench {
namespace {

struct Errors {
  double velocity = 0;
  double acceleration = 0;
};

// calm: only where no ramp begins or ends within a tenth of a second.
Errors errors_of(const std::vector<testing::RawSample>& truth, const std::vector<double>& velocity,
                 const std::vector<double>& acceleration, bool calm) {
  Errors e;
  double rows = 0;
  for (std::size_t i = 300; i + 300 < truth.size(); ++i) {
    const auto ramps = [&](const testing::RawSample& s) { return std::abs(s.acceleration) > 0.1; };
    if (calm && std::any_of(&truth[i - 50], &truth[i + 50], ramps)) continue;
    ++rows;
    e.velocity += std::pow(velocity[i] - truth[i].velocity, 2);
    e.acceleration += std::pow(acceleration[i] - truth[i].acceleration, 2);
  }
  return {std::sqrt(e.velocity / rows), std::sqrt(e.acceleration / rows)};
}

// The slope of a parabola through 2m+1 neighbours, at the m that is best knowing the truth.
double best_savitzky_golay(const std::vector<testing::RawSample>& truth,
                           const std::vector<double>& q, double step) {
  double best = std::numeric_limits<double>::infinity();
  for (int m = 2; m < 200; m = m * 14 / 10 + 1) {
    double squares = 0;
    for (int k = -m; k <= m; ++k) squares += k * k;
    double sum = 0;
    double rows = 0;
    for (std::size_t i = 300; i + 300 < q.size(); ++i, ++rows) {
      double slope = 0;
      for (int k = -m; k <= m; ++k) {
        slope += k * q[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + k)];
      }
      sum += std::pow(slope / squares / step - truth[i].velocity, 2);
    }
    best = std::min(best, std::sqrt(sum / rows));
  }
  return best;
}

// With its bandwidth from the data alone it is better than a Savitzky-Golay filter whose width
// was chosen by the truth, on encoders of 2^12 to 2^20 counts a turn.
TEST(MotionSmoother, IsBetterThanTheBestSavitzkyGolayFilter) {
  for (const int bits : {12, 14, 16, 20}) {
    testing::RawLogPlan plan;
    plan.encoder_bits = bits;
    const std::vector<testing::RawSample> truth = simulate(plan);
    const double count = 2 * std::numbers::pi / std::pow(2.0, bits);
    std::vector<double> time;
    std::vector<double> q;
    for (const testing::RawSample& sample : truth) {
      time.push_back(sample.time);
      q.push_back((std::floor(sample.position / count) + 0.5) * count);
    }
    const std::vector<RowRange> whole = {{0, q.size()}};
    const Motion motion = MotionSmoother(time, q, whole).smoothed();
    const Errors ours = errors_of(truth, motion.velocity, motion.acceleration, false);
    const Errors calm = errors_of(truth, motion.velocity, motion.acceleration, true);
    const double theirs = best_savitzky_golay(truth, q, plan.step);
    RecordProperty("velocity_error_2^" + std::to_string(bits), std::to_string(ours.velocity));
    RecordProperty("savitzky_golay_2^" + std::to_string(bits), std::to_string(theirs));
    EXPECT_LT(ours.velocity, theirs) << bits;
    EXPECT_LT(calm.velocity, 3 * motion.velocity_noise) << bits;
    EXPECT_GT(calm.velocity, motion.velocity_noise / 10) << bits;
    if (bits < 20) EXPECT_NEAR(resolution_of(q), count, 1e-9) << bits;
  }
}

TEST(MotionSmoother, UnevenStepsAndAGapDoNoHarm) {
  std::vector<double> time;
  std::vector<double> q;
  double t = 0;
  for (int i = 0; i < 4000; ++i) {
    t += 0.002 + 0.001 * ((i * 7919) % 10) / 10.0 + (i == 2000 ? 3.0 : 0.0);
    time.push_back(t);
    q.push_back(0.7 * std::sin(1.3 * t));
  }
  const std::vector<RowRange> pieces = {{0, 2000}, {2000, 4000}};
  const Motion motion = MotionSmoother(time, q, pieces).smoothed();
  for (std::size_t i = 50; i + 50 < q.size(); ++i) {
    if (i > 1950 && i < 2050) continue;
    ASSERT_NEAR(motion.velocity[i], 0.7 * 1.3 * std::cos(1.3 * time[i]), 2e-3) << i;
    ASSERT_TRUE(std::isfinite(motion.acceleration[i]));
  }
}

// Where messages are lost the motion is known far worse for a moment: that is not the recording's
// noise, by which rests are told and accelerations believed.
TEST(MotionSmoother, LostMessagesDoNotRaiseTheNoise) {
  testing::RawLogPlan plan;
  plan.encoder_bits = 14;
  const double count = 2 * std::numbers::pi / std::pow(2.0, plan.encoder_bits);
  std::vector<double> time;
  std::vector<double> q;
  for (const testing::RawSample& sample : simulate(plan)) {
    time.push_back(sample.time);
    q.push_back(std::floor(sample.position / count) * count);
  }
  const std::vector<RowRange> whole = {{0, q.size()}};
  std::vector<RowRange> pieces;
  for (std::size_t begin = 0; begin + 1000 < q.size(); begin += 1000) {
    pieces.push_back({begin, begin + 950});
    pieces.push_back({begin + 960, begin + 972});  // a few messages between two losses
  }
  const Motion steady = MotionSmoother(time, q, whole).smoothed();
  const Motion lossy = MotionSmoother(time, q, pieces).smoothed();
  EXPECT_LT(lossy.velocity_noise, 1.5 * steady.velocity_noise);
  EXPECT_LT(lossy.acceleration_noise, 1.5 * steady.acceleration_noise);
}

TEST(MotionSmoother, ALongRestAtTheBeginLeavesFiniteNumbers) {
  std::vector<double> time;
  std::vector<double> q;
  for (int i = 0; i < 5000; ++i) {
    time.push_back(0.001 * i);
    q.push_back(i < 2000 ? 0.0 : std::floor((i - 2000) * 0.3) * 1e-3);
  }
  const std::vector<RowRange> whole = {{0, q.size()}};
  const Motion motion = MotionSmoother(time, q, whole).smoothed();
  for (const double v : motion.velocity) ASSERT_TRUE(std::isfinite(v));
}

// A position without noise may be followed from row to row: 100 rows a second show an acceleration
// that is another in every tenth of a second.
TEST(MotionSmoother, APositionWithoutNoiseIsFollowedFromRowToRow) {
  constexpr double kStep = 0.01;
  constexpr double kAcceleration = 5;
  RandomStream random(key_of("rough"));
  std::vector<double> time;
  std::vector<double> q;
  std::vector<double> a;
  double v = 0;
  double position = 0;
  double now = 0;
  for (int i = 0; i < 4000; ++i) {
    if (i % 10 == 0) now = kAcceleration * random.normal() - v;
    time.push_back(kStep * i);
    q.push_back(position);
    a.push_back(now);
    position += kStep * v + 0.5 * kStep * kStep * now;
    v += kStep * now;
  }
  const std::vector<RowRange> whole = {{0, q.size()}};
  const Motion motion = MotionSmoother(time, q, whole).smoothed();
  double squares = 0;
  for (std::size_t i = 100; i + 100 < q.size(); ++i) {
    // Straight between rows: at an instant of a change the mean of both.
    squares += std::pow(motion.acceleration[i] - 0.5 * (a[i] + a[i - 1]), 2);
  }
  EXPECT_LT(std::sqrt(squares / 3800), 0.07 * kAcceleration);
}

}  // namespace
}  // namespace tribench
