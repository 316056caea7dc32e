// SPDX-License-Identifier: MIT
#include "problems/friction/law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "problems/kuka/joint.hpp"

namespace tribench {
namespace {

TEST(FrictionLaw, GivesHandComputedValues) {
  FrictionLaw law;
  law.positive = {8, 15, 4};
  law.negative = {9, 16, 5};
  law.load_coulomb = 0.03;
  law.mean_load_nm = 30;
  law.quadrant_gain = 0.08;
  law.quadrant_step_nm = 1.5;
  // 8 + 7.5 - 0.25 + 0.03 (40 - 30) + 3.2 + 1.5 tanh(80)
  EXPECT_DOUBLE_EQ(law.at(0.5, 40), 8 + 7.5 - 0.25 + 0.3 + 3.2 + 1.5);
  // -(9 + 8 - 0.3125) - 0.3 + 3.2 + 1.5
  EXPECT_DOUBLE_EQ(law.at(-0.5, 40), -(9 + 8 - 0.3125) - 0.3 + 3.2 + 1.5);
  EXPECT_DOUBLE_EQ(law.averaged_at(-0.5), -(9 + 8 - 0.3125));
  EXPECT_DOUBLE_EQ(law.at(0, 0), 0);
}

TEST(FrictionLaw, IsTheSameForAColumnBitForBit) {
  const kuka::Joint joint = kuka::make_joint(2, 7);
  std::vector<double> x;
  for (int i = 0; i < 1001; ++i) x.push_back(-45 + 0.09 * i);
  for (const double v : {-0.3, 0.0, 0.6}) {
    const std::vector<double> law = joint.law.at(v, x);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(law[i], joint.law.at(v, x[i])) << x[i];
  }
  const std::vector<double> ripple = ripple_at(joint.ripple, x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(ripple[i], ripple_at(joint.ripple, x[i])) << x[i];
  }
}

TEST(FrictionLaw, ItsFormulaIsTheLaw) {
  const std::vector<std::string> names = {"qd", "sgn_qd", "g", "sgn_g"};
  Evaluator evaluator;
  for (const int number : {2, 4}) {
    const kuka::Joint joint = kuka::make_joint(number, 7);
    const Expression loaded = parse(joint.law.formula(true), names);
    const Expression averaged = parse(joint.law.formula(false, 0.25), names);
    for (const double v : {-0.68, -0.3, -0.015, 0.015, 0.4, 0.68}) {
      for (const double g : {-40.0, -0.2, 0.1, 12.0}) {
        const std::vector<double> point = {v, v > 0 ? 1.0 : -1.0, g, g > 0 ? 1.0 : -1.0};
        EXPECT_NEAR(evaluator.evaluate_at(loaded, point), joint.law.at(v, g), 1e-12);
        EXPECT_NEAR(evaluator.evaluate_at(averaged, point), joint.law.averaged_at(v) + 0.25, 1e-12);
      }
    }
  }
}

TEST(FrictionLaw, AveragingOverTheStrokeLeavesTheDirectionalCurve) {
  const kuka::Joint joint = kuka::make_joint(2, 1);
  for (const double v : {0.2, -0.5}) {
    constexpr int kPoints = 200000;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double q = kuka::kStrokeEnd_rad * (2 * (i + 0.5) / kPoints - 1);
      sum += joint.law.at(v, joint.gravity_amplitude_nm * std::sin(q)) + ripple_at(joint.ripple, q);
    }
    EXPECT_NEAR(sum / kPoints, joint.law.averaged_at(v) + joint.mean_ripple_nm(), 1e-6);
  }
}

}  // namespace
}  // namespace tribench
