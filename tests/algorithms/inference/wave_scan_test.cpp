// SPDX-License-Identifier: MIT
#include "algorithms/inference/wave_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tests/algorithms/inference/rows_with_noise.hpp"

namespace tribench::loop {
namespace {

constexpr double kAlpha = 0.05;
constexpr std::size_t kFlips = 399;

// Movements there and back over two units of length, one after the other.
struct Strokes {
  Clusters clusters = many_movements();
  std::vector<double> coordinate;
  Eigen::VectorXf direction;

  explicit Strokes(RandomStream random) : direction(kMovements * kRows) {
    for (std::size_t m = 0; m < kMovements; ++m) {
      const double reach = random.uniform(0.6, 1);
      for (std::size_t i = 0; i < kRows; ++i) {
        const float way = m % 2 == 0 ? 1 : -1;
        direction[static_cast<Eigen::Index>(m * kRows + i)] = way;
        coordinate.push_back(
            -way * reach *
            std::cos(std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(kRows)));
      }
    }
  }

  WaveRange range() const { return waves_over(coordinate, 2, 0.02).value(); }
  Wave strongest(const Eigen::VectorXd& scores) const {
    return strongest_wave(coordinate, scores, direction, clusters, range(), kFlips, kAlpha,
                          RandomStream(5));
  }
};

// Rows that follow one another may be alike: movements are what is flipped.
TEST(StrongestWave, IsFoundInNoiseNoMoreOftenThanStated) {
  const Strokes strokes(RandomStream(1));
  constexpr int kRuns = 300;
  int found = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Eigen::VectorXd noise = noise_of(RandomStream(2).split(run), 2);
    if (strokes.strongest(noise).p <= kAlpha) ++found;
  }
  // The upper end of what chance makes of 5 %; the test is no use if it never finds anything.
  EXPECT_LE(found, 26);
  EXPECT_GE(found, 1);
}

TEST(StrongestWave, IsTheOneThatIsThereWithItsDirectionAtOneMistakeInManyFlips) {
  const Strokes strokes(RandomStream(1));
  const Eigen::VectorXd noise = noise_of(RandomStream(3), 1);
  for (const double wavenumber : {9.3, 61.7, 250.0}) {
    for (const bool is_turned : {false, true}) {
      Eigen::VectorXd scores = noise;
      for (Eigen::Index i = 0; i < scores.size(); ++i) {
        const double x = strokes.coordinate[static_cast<std::size_t>(i)];
        const double way = is_turned ? static_cast<double>(strokes.direction[i]) : 1;
        scores[i] += 0.5 * way * std::cos(wavenumber * x + 1);
      }
      const Wave wave = strokes.strongest(scores);
      EXPECT_NEAR(wave.wavenumber, wavenumber, strokes.range().step) << is_turned;
      EXPECT_EQ(wave.is_turned, is_turned) << wavenumber;
      EXPECT_DOUBLE_EQ(wave.p, 1.0 / (kFlips + 1));
    }
  }
}

TEST(StrongestWave, IsTheSameInAnyUnit) {
  const Strokes strokes(RandomStream(1));
  const Eigen::VectorXd noise = noise_of(RandomStream(4), 1);
  const Wave wave = strokes.strongest(noise);
  for (const double unit : {1e-200, 1e-30, 1e30, 1e200}) {
    const Wave again = strokes.strongest(noise * unit);
    EXPECT_DOUBLE_EQ(again.wavenumber, wave.wavenumber) << unit;
    EXPECT_DOUBLE_EQ(again.p, wave.p) << unit;
  }
  EXPECT_DOUBLE_EQ(strokes.strongest(noise * 0).p, 1);
}

TEST(WavesOver, GoFromTheFewestOverTheSpanToTheShortest) {
  const std::vector<double> coordinate = {0, 2, -1, 3};
  const WaveRange range = waves_over(coordinate, 2, 0.1).value();
  EXPECT_DOUBLE_EQ(range.low, 2 * 2 * std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(range.high, 2 * std::numbers::pi / 0.1);
  EXPECT_DOUBLE_EQ(range.step, 2 * std::numbers::pi / 4 / 4);
  EXPECT_DOUBLE_EQ(waves_over(coordinate, 2, 1e-9)->high, 1000 * 2 * std::numbers::pi / 4);
  EXPECT_FALSE(waves_over(coordinate, 2, 2).has_value());
  EXPECT_FALSE(waves_over(std::vector<double>{1, 1}, 2, 0.1).has_value());
}

}  // namespace
}  // namespace tribench::loop
