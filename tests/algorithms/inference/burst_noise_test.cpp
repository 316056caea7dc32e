// SPDX-License-Identifier: MIT
#include "algorithms/inference/burst_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "foundation/order_statistics.hpp"
#include "foundation/random.hpp"

namespace tribench::loop::burst_noise_test {
namespace {

constexpr std::size_t kMovements = 200;
constexpr std::size_t kRows = 40;
constexpr double kSpread = 0.2;  // of the movements' levels
constexpr double kRho = 0.6;

// Student noise with 5 degrees of freedom, a level a movement, twice as wide at full speed as at 0.
struct Example {
  std::vector<int> movement;
  std::vector<double> speed;
  Eigen::VectorXd residual;
  std::vector<double> unit;  // the truth: the scale of each row's innovation
};

Example example(RandomStream random) {
  Example e;
  const StudentLaw law{5, 1};
  e.residual.resize(static_cast<Eigen::Index>(kMovements * kRows));
  for (std::size_t m = 0; m < kMovements; ++m) {
    const double level = std::exp(kSpread * random.normal());
    double state = 0;
    for (std::size_t i = 0; i < kRows; ++i) {
      const double v = static_cast<double>((m + i) % kRows) / kRows;
      state = kRho * state + law.draw(random) * (i == 0 ? 1 / std::sqrt(1 - kRho * kRho) : 1);
      e.unit.push_back(level * (0.5 + 0.5 * v));
      e.residual[static_cast<Eigen::Index>(e.unit.size() - 1)] = e.unit.back() * state;
      e.speed.push_back(v);
      e.movement.push_back(static_cast<int>(m));
    }
  }
  return e;
}

TEST(BurstNoise, KnowsEachMovementsLevelAsWellAsItSays) {
  const Example e = example(RandomStream(1));
  const BurstNoise noise(e.movement, e.speed, e.residual);
  EXPECT_EQ(noise.law().above.freedom, 5);
  EXPECT_NEAR(noise.rho(), kRho, 0.03);
  // A movement's first row has none before it: it is an innovation by itself.
  const double first = noise.deviation()[0] / noise.unit()[0];
  EXPECT_NEAR(noise.innovation()[0], first * std::sqrt(1 - noise.rho() * noise.rho()), 1e-9);
  double squares = 0;
  for (std::size_t m = 0; m < kMovements; ++m) {
    const std::size_t row = m * kRows + 10;
    const double taken = noise.unit()[row] * noise.law().scale() * noise.level_without(m, row, 7);
    const double off = std::log(taken / e.unit[row]) / noise.level_error(m, 7);
    squares += off * off;
  }
  // 1 is expected; its standard error is 0.1.
  EXPECT_NEAR(squares / static_cast<double>(kMovements), 1, 0.35);
}

// Of a movement that is left out whole nothing is known but what the others' levels are like: e
// times as loud from one to the next, the one in the middle typical.
TEST(BurstNoise, AMovementLeftOutWholeIsAsLoudAsTheOthersAreApart) {
  constexpr std::size_t kLong = 600;
  RandomStream random(4);
  const StudentLaw law{5, 0.5};
  std::vector<int> movement;
  Eigen::VectorXd residual(3 * kLong);
  for (std::size_t i = 0; i < kLong; ++i) {
    const double drawn = law.draw(random);
    for (std::size_t m = 0; m < 3; ++m) {
      residual[static_cast<Eigen::Index>(m * kLong + i)] =
          drawn * std::exp(static_cast<double>(m) - 1);
    }
  }
  for (std::size_t i = 0; i < 3 * kLong; ++i) movement.push_back(static_cast<int>(i / kLong));
  const BurstNoise noise(movement, {}, residual);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_NEAR(noise.level_error(m, kLong), 1, 0.02);
    const double typical =
        noise.unit()[m * kLong] * noise.law().scale() * noise.level_without(m, m * kLong, kLong);
    EXPECT_NEAR(typical, law.scale(), 0.06);
    const double own = noise.unit()[m * kLong] * noise.law().scale();
    EXPECT_NEAR(std::log(own / law.scale()), static_cast<double>(m) - 1, 0.1);
  }
}

TEST(BurstNoise, ABurstDoesNotHideInTheNoiseThatItMakes) {
  Example e = example(RandomStream(2));
  constexpr std::size_t kMovement = 17;
  constexpr std::size_t kFirst = kMovement * kRows + 15;
  const BurstNoise without(e.movement, e.speed, e.residual);
  for (std::size_t k = 0; k < 6; ++k) {
    e.residual[static_cast<Eigen::Index>(kFirst + k)] += 8 * std::sin(0.5236 * (k + 0.5));
  }
  const BurstNoise with(e.movement, e.speed, e.residual);
  const double as_taken = with.unit()[kFirst] / without.unit()[kFirst];
  EXPECT_GT(as_taken, 1.05);
  const double left_out = with.unit()[kFirst] * with.level_without(kMovement, kFirst, 7) /
                          (without.unit()[kFirst] * without.level_without(kMovement, kFirst, 7));
  EXPECT_NEAR(left_out, 1, 0.02);
}

// A burst of a fiftieth of a movement's rows hardly moves its level: the rest is not looked at.
TEST(BurstNoise, FewRowsOfManyChangeNoLevel) {
  RandomStream random(5);
  std::vector<int> movement(300, 0);
  movement.resize(601, 1);
  const StudentLaw law{5, 1};
  Eigen::VectorXd residual(601);
  for (double& row : residual) row = law.draw(random);
  const BurstNoise noise(movement, {}, residual);
  EXPECT_EQ(noise.level_without(0, 10, 5), 1);
  EXPECT_NE(noise.level_without(0, 10, 6), 1);
  EXPECT_EQ(noise.level_without(1, 310, 6), 1);
  EXPECT_NE(noise.level_without(1, 310, 7), 1);
}

// Of a movement of which two rows are left nothing more is known than of one left out whole; three
// say something.
TEST(BurstNoise, ThreeRowsThatAreLeftSaySomething) {
  const Example e = example(RandomStream(6));
  const BurstNoise noise(e.movement, e.speed, e.residual);
  const std::size_t first = 3 * kRows;
  EXPECT_EQ(noise.level_error(3, kRows - 2), noise.level_error(3, kRows));
  EXPECT_LT(noise.level_error(3, kRows - 3), noise.level_error(3, kRows));
  EXPECT_EQ(noise.level_without(3, first, kRows - 2), noise.level_without(3, first, kRows));
  EXPECT_NE(noise.level_without(3, first, kRows - 3), noise.level_without(3, first, kRows));
}

// However smooth: neighbours are taken to agree by 0.998 at most.
TEST(BurstNoise, LeavesInnovationsInADrift) {
  const std::vector<int> movement(3000, 0);
  const Eigen::VectorXd drift = Eigen::VectorXd::NullaryExpr(
      3000, [](Eigen::Index i) { return std::sin(6.283185307 * static_cast<double>(i) / 3000); });
  EXPECT_EQ(BurstNoise(movement, {}, drift).rho(), 0.998);
}

// A residual that is zero nearly everywhere has no noise by which a row could stand out.
TEST(BurstNoise, WithoutNoiseThereIsNothingElse) {
  const std::vector<int> movement(100, 0);
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(100);
  residual[50] = 3;
  const BurstNoise noise(movement, {}, residual);
  EXPECT_EQ(noise.robust_sd(), 0);
  EXPECT_TRUE(noise.innovation().empty());
  EXPECT_EQ(noise.rho(), 0);
  EXPECT_EQ(BurstNoise({}, {}, Eigen::VectorXd()).robust_sd(), 0);
}

// Of neighbours in one movement; what lies beyond three standard deviations counts as three.
double correlation(const std::vector<double>& rows, double sd) {
  double product = 0;
  double square = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double now = std::clamp(rows[i], -3 * sd, 3 * sd);
    square += now * now;
    if (i % kRows > 0) product += now * std::clamp(rows[i - 1], -3 * sd, 3 * sd);
  }
  return product / square;
}

double robust_sd_of(std::vector<double> rows) {
  for (double& row : rows) row = std::abs(row);
  return kMadToSd * median(rows);
}

// Offsets are the movements' medians, less the share that the noise makes of them: of a median of n
// normal rows the variance is pi / 2 of the mean's.
TEST(BurstNoise, OffsetsAndCorrelationAreThoseOfTheirDefinition) {
  Example e = example(RandomStream(7));
  RandomStream random(8);
  for (std::size_t m = 0; m < kMovements; ++m) {
    const double offset = 0.4 * random.normal();
    for (std::size_t i = 0; i < kRows; ++i) {
      e.residual[static_cast<Eigen::Index>(m * kRows + i)] += offset;
    }
  }
  std::vector<double> left(e.residual.data(), e.residual.data() + e.residual.size());
  std::vector<double> middles;
  double spread = 0;
  for (std::size_t m = 0; m < kMovements; ++m) {
    const auto rows = std::span(left).subspan(m * kRows, kRows);
    middles.push_back(median(rows));
    for (double& row : rows) row -= middles.back();
    spread += middles.back() * middles.back() / kMovements;
  }
  const double sd = robust_sd_of(left);
  const double rho = correlation(left, sd);
  const double shrunk = 3.14159265358979 / 2 * sd * sd * (1 + rho) / (1 - rho) / kRows / spread;
  ASSERT_LT(shrunk, 0.9);
  for (std::size_t i = 0; i < left.size(); ++i) left[i] += shrunk * middles[i / kRows];
  const BurstNoise noise(e.movement, {}, e.residual);
  for (std::size_t i = 0; i < left.size(); ++i) {
    ASSERT_NEAR(noise.deviation()[i], left[i], 1e-9) << i;
  }
  EXPECT_NEAR(noise.robust_sd(), robust_sd_of(left), 1e-9);
  EXPECT_NEAR(noise.rho(), correlation(left, noise.robust_sd()), 1e-9);
}

TEST(BurstNoise, KnowsWhichMovementARowIsOf) {
  const std::vector<int> movement = {7, 7, 7, 2, 2, 9};
  const BurstNoise noise(movement, {}, Eigen::VectorXd::Zero(6));
  const std::vector<std::size_t> expected = {0, 0, 0, 1, 1, 2};
  for (std::size_t i = 0; i < movement.size(); ++i) EXPECT_EQ(noise.movement_at(i), expected[i]);
}

}  // namespace
}  // namespace tribench::loop::burst_noise_test
