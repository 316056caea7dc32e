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
    EXPECT_EQ(found.freedom, law.freedom);
    EXPECT_NEAR(found.scale, law.scale, 0.03 * law.scale);
  }
}

TEST(StudentLaw, OfNormalNoiseHasTheLightestTails) {
  RandomStream random(3);
  std::vector<double> draws(20000);
  for (double& draw : draws) draw = random.normal();
  EXPECT_EQ(fit_student(draws).freedom, 40);
}

}  // namespace
}  // namespace tribench::loop
