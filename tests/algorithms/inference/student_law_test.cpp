// SPDX-License-Identifier: MIT
#include "algorithms/inference/student_law.hpp"

#include <gtest/gtest.h>

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
