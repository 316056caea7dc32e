// SPDX-License-Identifier: MIT
#include "algorithms/inference/bursts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "algorithms/inference/student_law.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kMovements = 60;
constexpr std::size_t kRows = 60;

std::vector<int> movements() {
  std::vector<int> movement;
  for (std::size_t i = 0; i < kMovements * kRows; ++i) {
    movement.push_back(static_cast<int>(i / kRows));
  }
  return movement;
}

// Student noise with 5 degrees of freedom, neighbours correlated by 0.6, unit variance.
Eigen::VectorXd noise(RandomStream random) {
  const StudentLaw law{5, std::sqrt(3.0 / 5.0)};
  Eigen::VectorXd r(static_cast<Eigen::Index>(kMovements * kRows));
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const bool first = i % static_cast<Eigen::Index>(kRows) == 0;
    r[i] = first ? law.draw(random) : 0.6 * r[i - 1] + 0.8 * law.draw(random);
  }
  return r;
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

TEST(Bursts, ARecordingWithoutNoiseHasNone) {
  EXPECT_TRUE(bursts_of(Eigen::VectorXd::Zero(kMovements * kRows), 1).empty());
}

TEST(Bursts, OnlyRowsOfItsOwnMovementAreMaskedAboutOne) {
  const std::vector<Burst> bursts = {{60, 64, 9, 20}};
  const std::vector<char> masked = rows_about(bursts, movements());
  EXPECT_EQ(masked[59], 0);  // the movement before
  EXPECT_EQ(masked[60], 1);
  EXPECT_EQ(masked[68], 1);
  EXPECT_EQ(masked[69], 0);
}

TEST(StudentLaw, IsRecoveredFromItsDraws) {
  RandomStream random(3);
  for (const double freedom : {3.0, 5.0, 40.0}) {
    const StudentLaw law{freedom, 0.7};
    std::vector<double> z;
    for (int i = 0; i < 40000; ++i) z.push_back(law.draw(random));
    const StudentLaw fitted = fit_student(z);
    EXPECT_EQ(fitted.freedom, freedom);
    EXPECT_NEAR(fitted.scale, 0.7, 0.02);
  }
}

}  // namespace
}  // namespace tribench::loop
