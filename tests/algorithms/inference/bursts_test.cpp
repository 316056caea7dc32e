// SPDX-License-Identifier: MIT
#include "algorithms/inference/bursts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "algorithms/inference/burst_noise.hpp"
#include "algorithms/inference/student_law.hpp"

namespace tribench::loop::bursts_test {
namespace {

constexpr std::size_t kMovements = 60;
constexpr std::size_t kBurstRows = 60;

std::vector<int> movements() {
  std::vector<int> movement;
  for (std::size_t i = 0; i < kMovements * kBurstRows; ++i) {
    movement.push_back(static_cast<int>(i / kBurstRows));
  }
  return movement;
}

// Every row from what the one before leaves of it: neighbours correlated by 0.6, of the variance of
// what is drawn.
Eigen::VectorXd correlated(const std::function<double()>& draw) {
  Eigen::VectorXd r(static_cast<Eigen::Index>(kMovements * kBurstRows));
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const bool first = i % static_cast<Eigen::Index>(kBurstRows) == 0;
    r[i] = first ? draw() : 0.6 * r[i - 1] + 0.8 * draw();
  }
  return r;
}

// Student noise of unit variance.
Eigen::VectorXd noise(RandomStream random, double freedom = 5) {
  const StudentLaw law{freedom, std::sqrt((freedom - 2) / freedom)};
  return correlated([&] { return law.draw(random); });
}

// Four times as wide above 0 as below it.
Eigen::VectorXd skewed_noise(RandomStream random) {
  StudentLaw law;
  law.below = {40, 0.35};
  law.above = {7, 1.4};
  return correlated([&] { return law.draw(random); });
}

std::vector<Burst> bursts_of(const Eigen::VectorXd& residual, std::uint64_t seed) {
  return find_bursts(movements(), {}, residual, RandomStream(seed));
}

TEST(Bursts, CleanRecordingsWithHeavyTailsHardlyEverHoldOne) {
  int with = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    with += bursts_of(noise(RandomStream(seed)), seed).empty() ? 0 : 1;
  }
  EXPECT_LE(with, 6);  // 2 are expected; more than 6 in one of 200
}

TEST(Bursts, CleanRecordingsWithALongTailToOneSideHardlyEverHoldOne) {
  int with = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    with += bursts_of(skewed_noise(RandomStream(seed)), seed).empty() ? 0 : 1;
  }
  EXPECT_LE(with, 6);  // 2 are expected; more than 6 in one of 200
}

// Bit for bit, where the noise is skewed and where many rows lie at its middle.
TEST(Bursts, OfAMirroredRecordingAreTheSame) {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Eigen::VectorXd residual = skewed_noise(RandomStream(seed));
    for (Eigen::Index k = 0; k < 9; ++k) residual[700 + k] += seed % 2 == 0 ? 9 : -9;
    if (seed % 3 == 0) residual = residual.array().round();
    const std::vector<Burst> told = bursts_of(residual, seed);
    const std::vector<Burst> mirrored = bursts_of(-residual, seed);
    ASSERT_EQ(told.size(), mirrored.size()) << seed;
    for (std::size_t k = 0; k < told.size(); ++k) {
      EXPECT_EQ(told[k].begin, mirrored[k].begin);
      EXPECT_EQ(told[k].end, mirrored[k].end);
      EXPECT_EQ(told[k].peak, mirrored[k].peak);
      EXPECT_EQ(told[k].log_ratio, mirrored[k].log_ratio);
    }
    found += told.size();
  }
  EXPECT_GE(found, 25U);
}

// Of such noise nearly every recording has rows beyond six robust standard deviations: that they
// are none is for the threshold alone to say.
TEST(Bursts, CleanRecordingsWithTheHeaviestTailsHardlyEverHoldOne) {
  int with = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    with += bursts_of(noise(RandomStream(seed), 3), seed).empty() ? 0 : 1;
  }
  EXPECT_LE(with, 6);  // 2 are expected; more than 6 in one of 200
}

// Four times as loud for twenty rows at a time, a twelfth of all rows; no shape and no side. In
// movements of 180 rows.
Eigen::VectorXd in_loud_spells(RandomStream random) {
  Eigen::VectorXd r(static_cast<Eigen::Index>(kMovements * kBurstRows));
  bool loud = false;
  for (double& row : r) {
    if (random.chance(loud ? 1 / 20.0 : 1 / 220.0)) loud = !loud;
    row = (loud ? 4 : 1) * random.normal();
  }
  return r;
}

std::vector<Burst> bursts_of_spells(const Eigen::VectorXd& residual, std::uint64_t seed) {
  std::vector<int> movement = movements();
  for (int& one : movement) one /= 3;
  return find_bursts(movement, {}, residual, RandomStream(seed));
}

TEST(Bursts, NoiseThatComesInLoudSpellsHardlyEverHoldsOne) {
  int with = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    with += bursts_of_spells(in_loud_spells(RandomStream(seed)), seed).empty() ? 0 : 1;
  }
  EXPECT_LE(with, 5);  // 1 is expected; more than 5 in one of 1 700
}

TEST(Bursts, APulseStandsOutOfLoudSpells) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Eigen::VectorXd residual = in_loud_spells(RandomStream(seed));
    for (Eigen::Index k = 0; k < 9; ++k) {
      residual[630 + k] += 40 * std::sin(3.14159265 * (static_cast<double>(k) + 0.5) / 9);
    }
    found +=
        std::ranges::any_of(bursts_of_spells(residual, seed),
                            [](const Burst& burst) { return burst.begin < 639 && burst.end > 630; })
            ? 1
            : 0;
  }
  EXPECT_GE(found, 16);
}

TEST(Bursts, APulseIsFoundWhereItIsAndMasked) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Eigen::VectorXd residual = noise(RandomStream(seed));
    for (Eigen::Index k = 0; k < 6; ++k) {
      residual[630 + k] -= 8 * std::sin(3.14159265 * (static_cast<double>(k) + 0.5) / 6);
    }
    const std::vector<Burst> bursts = bursts_of(residual, seed);
    const std::vector<char> masked = rows_about(bursts, movements());
    for (const Burst& burst : bursts) {
      if (burst.begin > 636 || burst.end < 630) continue;
      ++found;
      EXPECT_GT(burst.peak, 4);
      EXPECT_EQ(masked[632], 1);
    }
  }
  EXPECT_GE(found, 93);
}

// The lengths that are looked for are told apart, the shortest and the longest too.
TEST(Bursts, APulseIsAsLongAsItWas) {
  for (const int rows : {4, 14}) {
    double length = 0;
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Eigen::VectorXd residual = noise(RandomStream(seed));
      for (Eigen::Index k = 0; k < rows; ++k) {
        residual[630 + k] += 12 * std::sin(3.14159265 * (static_cast<double>(k) + 0.5) / rows);
      }
      for (const Burst& burst : bursts_of(residual, seed)) {
        if (burst.begin > 640 || burst.end < 630) continue;
        ++found;
        length += static_cast<double>(burst.end - burst.begin);
      }
    }
    EXPECT_GE(found, 19) << rows;
    EXPECT_NEAR(length / found, rows, 0.2 * rows) << rows;
  }
}

// A wild row fades away by the noise's own correlation: four rows on one side, and no burst.
TEST(Bursts, OneWildRowThatFadesAwayIsNoBurst) {
  Eigen::VectorXd residual = noise(RandomStream(7));
  for (Eigen::Index k = 0; k < 12; ++k) {
    residual[1230 + k] += 14 * std::pow(0.6, static_cast<double>(k));
  }
  EXPECT_TRUE(bursts_of(residual, 7).empty());
}

// How many are found of so many pulses that are alike, in noise that itself makes none.
std::size_t found_of_alike(std::size_t pulses, std::size_t rows, std::size_t among) {
  RandomStream random(8);
  Eigen::VectorXd residual(static_cast<Eigen::Index>(among * kBurstRows));
  for (double& row : residual) row = random.uniform(-1, 1);
  for (std::size_t p = 0; p < pulses; ++p) {
    const std::size_t first = kBurstRows * (2 + 4 * p) + 30;
    for (std::size_t k = 0; k < rows; ++k) {
      residual[static_cast<Eigen::Index>(first + k)] +=
          12 * std::sin(3.14159265 * (static_cast<double>(k) + 0.5) / static_cast<double>(rows));
    }
  }
  const std::vector<int> movement = movements();
  return find_bursts(std::span(movement).first(among * kBurstRows), {}, residual, RandomStream(1))
      .size();
}

// Seven pulses that are alike stand out of noise that makes none; of eight it is the noise itself
// that comes in pulses, and each would have to stand out of the others.
TEST(Bursts, AFewThatAreAlikeAreBurstsAndMoreAreTheNoise) {
  EXPECT_EQ(found_of_alike(7, 6, kMovements), 7U);
  EXPECT_EQ(found_of_alike(8, 6, kMovements), 0U);
}

// Seven of fourteen rows each: of 60 rows a movement 98 are more than a twentieth up to 32 of them.
TEST(Bursts, RowsOfWhichMoreThanATwentiethWouldBeOneHaveAnotherModelsNoise) {
  EXPECT_EQ(found_of_alike(7, 14, 32), 0U);
  EXPECT_EQ(found_of_alike(7, 14, 34), 7U);
}

TEST(Bursts, ARecordingWithoutNoiseHasNone) {
  EXPECT_TRUE(bursts_of(Eigen::VectorXd::Zero(kMovements * kBurstRows), 1).empty());
}

TEST(Bursts, OnlyRowsOfItsOwnMovementAreMaskedAboutOne) {
  const std::vector<Burst> bursts = {{60, 64, 9, 20}};
  const std::vector<char> masked = rows_about(bursts, movements());
  EXPECT_EQ(masked[59], 0);  // the movement before
  EXPECT_EQ(masked[60], 1);
  EXPECT_EQ(masked[68], 1);
  EXPECT_EQ(masked[69], 0);
}

// How much likelier pulses make the innovations from row `first` on, straight from its definition:
// the level of the noise is integrated out over many places where the scan takes five.
struct Reference {
  double log_ratio = 0;
  std::size_t rows = 0;  // of the likeliest pulse
};

// From row to row and from movement to movement another.
std::vector<double> burst_speeds() {
  std::vector<double> all;
  for (std::size_t i = 0; i < kMovements * kBurstRows; ++i) {
    all.push_back(static_cast<double>(i * 37 % kBurstRows) / kBurstRows);
  }
  return all;
}

class BurstReference {
 public:
  BurstReference(const Eigen::VectorXd& residual, std::size_t first)
      : noise_(movements(), burst_speeds(), residual),
        first_(first),
        movement_(noise_.movement_at(first)),
        left_(noise_.movements()[movement_].end - first) {
    double towards = 0;
    for (std::size_t k = 0; k < std::min<std::size_t>(4, left_); ++k) {
      towards += noise_.innovation()[first + k];
    }
    side_ = towards > 0 ? noise_.robust_sd() : -noise_.robust_sd();
  }

  Reference best() const {
    Reference out;
    double sum = 0;
    double largest = 0;
    for (const std::size_t rows : {4U, 6U, 9U, 14U}) {
      const double null = likelihood(rows, 0);
      for (const double height : {6.0, 9.0, 14.0, 28.0, 80.0, fitted_height(rows)}) {
        const double ratio = likelihood(rows, height) / null;
        sum += ratio;
        if (ratio > largest) out.rows = rows;
        largest = std::max(largest, ratio);
      }
    }
    out.log_ratio = std::log(sum / 2 / (4 * 6));  // half the weight is the other side's
    return out;
  }

 private:
  double pulse(std::size_t rows, std::size_t k) const {
    return k < rows ? std::sin(3.14159265358979 * (static_cast<double>(k) + 0.5) /
                               static_cast<double>(rows))
                    : 0;
  }
  // What a pulse of unit height adds to the k-th innovation.
  double added(std::size_t rows, std::size_t k) const {
    const double own = pulse(rows, k) / noise_.unit()[first_ + k];
    return k == 0 ? own : own - noise_.rho() * pulse(rows, k - 1) / noise_.unit()[first_ + k - 1];
  }
  // By least squares, the lowest at least.
  double fitted_height(std::size_t rows) const {
    double product = 0;
    double square = 0;
    for (std::size_t k = 0; k < std::min(rows + 1, left_); ++k) {
      const double unit = side_ * added(rows, k);
      product += unit * noise_.innovation()[first_ + k];
      square += unit * unit;
    }
    return std::max(6.0, product / square);
  }
  // Over a normal logarithm of the level.
  double likelihood(std::size_t rows, double height) const {
    const std::size_t touched = std::min(rows + 1, left_);
    const double middle = noise_.level_without(movement_, first_, touched);
    const double error = noise_.level_error(movement_, touched);
    double sum = 0;
    for (double x = -7; x < 7; x += 0.05) {
      const double scale = middle * std::exp(error * x) * noise_.law().above.scale;
      const double freedom = noise_.law().above.freedom;
      double log = -x * x / 2;
      for (std::size_t k = 0; k < touched; ++k) {
        const double z =
            (noise_.innovation()[first_ + k] - height * side_ * added(rows, k)) / scale;
        log -= std::log(scale) + (freedom + 1) / 2 * std::log1p(z * z / freedom);
      }
      sum += std::exp(log);
    }
    return sum;
  }

  BurstNoise noise_;
  std::size_t first_;
  std::size_t movement_;
  std::size_t left_;  // rows to the movement's end
  double side_;
};

// Pulses of several lengths, heights and sides; the last ends with its movement.
TEST(Bursts, TheLogRatioIsThatOfItsDefinition) {
  struct Planted {
    Eigen::Index first;
    int rows;
    double height;
  };
  const std::vector<double> speed = burst_speeds();
  Eigen::VectorXd residual = noise(RandomStream(17));  // wider the faster
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    residual[i] *= 0.6 + 0.8 * speed[static_cast<std::size_t>(i)];
  }
  for (const Planted& p : {Planted{130, 4, 11}, Planted{625, 6, -14}, Planted{1220, 9, 12},
                           Planted{1830, 14, -20}, Planted{2452, 6, 30}, Planted{3056, 6, 16}}) {
    for (Eigen::Index k = 0; k < std::min<Eigen::Index>(p.rows, 60 - p.first % 60); ++k) {
      residual[p.first + k] +=
          p.height * std::sin(3.14159265 * (static_cast<double>(k) + 0.5) / p.rows);
    }
  }
  const std::vector<Burst> bursts = find_bursts(movements(), speed, residual, RandomStream(1));
  ASSERT_GE(bursts.size(), 5U);
  const BurstNoise noise(movements(), speed, residual);
  for (const Burst& burst : bursts) {
    const Reference reference = BurstReference(residual, burst.begin).best();
    EXPECT_NEAR(burst.log_ratio, reference.log_ratio, 0.02 * reference.log_ratio) << burst.begin;
    const std::size_t end = (burst.begin / kBurstRows + 1) * kBurstRows;
    EXPECT_EQ(burst.end, std::min(burst.begin + reference.rows, end));
    double peak = 0;
    for (std::size_t i = burst.begin; i < burst.end; ++i) {
      peak = std::max(peak, std::abs(noise.deviation()[i]));
    }
    EXPECT_EQ(burst.peak, peak);
  }
}

}  // namespace
}  // namespace tribench::loop::bursts_test
