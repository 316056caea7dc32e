// SPDX-License-Identifier: MIT
#include "algorithms/inference/student_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tribench::loop {
namespace {

TEST(StudentLaw, IsFoundFromItsOwnDraws) {
  for (const StudentLaw law : {StudentLaw{3, 0.7}, StudentLaw{5, 1.4}, StudentLaw{40, 1}}) {
    RandomStream random(key_of("student"));
    std::vector<double> draws(20000);
    for (double& draw : draws) draw = law.draw(random);
    const StudentLaw found = fit_student(draws);
    EXPECT_TRUE(found.is_even());
    EXPECT_EQ(found.above.freedom, law.above.freedom);
    EXPECT_NEAR(found.scale(), law.scale(), 0.03 * law.scale());
  }
}

TEST(StudentLaw, OfSkewedNoiseIsFoundOnEitherSide) {
  StudentLaw skewed;
  skewed.below = {40, 0.5};
  skewed.above = {5, 1.2};
  RandomStream random(key_of("skewed"));
  std::vector<double> draws(20000);
  for (double& draw : draws) draw = skewed.draw(random);
  const StudentLaw found = fit_student(draws);
  EXPECT_EQ(found.below.freedom, 40);
  EXPECT_EQ(found.above.freedom, 5);
  EXPECT_NEAR(found.below.scale, 0.5, 0.015);
  EXPECT_NEAR(found.above.scale, 1.2, 0.036);
  // At 0 a t density is less high the heavier its tails are, and the wider it is.
  EXPECT_NEAR(found.log_density_ratio, std::log(0.3796 / 1.2 / (0.3965 / 0.5)), 0.05);
}

TEST(StudentLaw, OfEvenNoiseIsTheSameOnBothSides) {
  int uneven = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomStream random(seed);
    std::vector<double> draws(2000);
    for (double& draw : draws) draw = StudentLaw(5, 1).draw(random);
    uneven += fit_student(draws).is_even() ? 0 : 1;
  }
  EXPECT_LE(uneven, 2);
}

TEST(StudentLaw, OfNormalNoiseHasTheLightestTails) {
  RandomStream random(3);
  std::vector<double> draws(20000);
  for (double& draw : draws) draw = random.normal();
  EXPECT_EQ(fit_student(draws).above.freedom, 40);
}

// Whatever it starts from; of rows that are all zero it is the least that is told from nothing.
TEST(LevelOf, IsTheScaleAsAMultipleOfTheLaws) {
  const StudentLaw law{5, 0.7};
  RandomStream random(4);
  std::vector<double> draws(20000);
  for (double& draw : draws) draw = 3 * law.draw(random);
  EXPECT_NEAR(level_of(draws, law, 1, 20), 3, 0.06);
  EXPECT_NEAR(level_of(draws, law, 10, 20), level_of(draws, law, 1, 20), 1e-6);
  // One step from where it ends stays there; eight from elsewhere come near.
  const double end = level_of(draws, law, 1, 60);
  EXPECT_NEAR(level_of(draws, law, end, 1), end, 1e-9);
  EXPECT_NEAR(level_of(draws, law, 1, kLevelIterations), end, 0.01);
  EXPECT_NEAR(level_of(std::vector<double>(9, 0.0), law, 1, 1), kLeastLevel, 1e-12);
}

// Two rows of one size: of a t law with nu degrees of freedom and scale s the likelihood is largest
// where x^2 = s^2, whatever nu is.
TEST(LevelOf, OfRowsOfOneSizeIsThatSize) {
  for (const double freedom : {3.0, 40.0}) {
    EXPECT_NEAR(level_of(std::vector{0.6, -0.6}, {freedom, 0.2}, 1, 200), 3, 1e-6);
  }
}

TEST(StudentLaw, OfRowsWithoutNoiseHasAScaleAllTheSame) {
  EXPECT_NEAR(fit_student(std::vector<double>(20, 0.0)).scale(), 1e-6, 1e-12);
}

}  // namespace
}  // namespace tribench::loop
