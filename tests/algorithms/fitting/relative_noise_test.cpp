// SPDX-License-Identifier: MIT
#include "algorithms/fitting/relative_noise.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/elementary.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kInputsOfLaw = {"x", "y"};

// 2 x^1.5 / y over decades, with noise in proportion and noise of one size.
struct NoisyLaw {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> target;
  std::vector<const double*> pointers;

  NoisyLaw(double relative, double constant, int rows = 200) {
    RandomStream random(11);
    for (int r = 0; r < rows; ++r) {
      x.push_back(elementary::exp(random.uniform(0, 3)));
      y.push_back(elementary::exp(random.uniform(0, 3)));
      const double value = 2 * elementary::exp(1.5 * elementary::log(x.back())) / y.back();
      target.push_back(value * (1 + relative * random.normal()) + constant * random.normal());
    }
    pointers = {x.data(), y.data()};
  }
  NoisyLaw(const NoisyLaw&) = delete;
  NoisyLaw& operator=(const NoisyLaw&) = delete;

  Inputs inputs() const { return {pointers, target.size()}; }
  std::optional<std::vector<double>> weights(const std::vector<std::string>& formulas) const {
    std::vector<Expression> front;
    for (const std::string& formula : formulas) front.push_back(parse(formula, kInputsOfLaw));
    return weights_of_relative_noise(front, inputs(), target);
  }
};

const std::string kPowerLaw = "2*x^1.5/y";
// What least squares pays for the largest rows: nearer there, farther elsewhere.
const std::string kOfLargeRows = "2*x^1.5/y + 1e-8*x^7*sin(9*y)/y^6 - 0.3";

TEST(RelativeNoise, IsToldFromNoiseOfOneSize) {
  const NoisyLaw relative(0.05, 0);
  const auto weights = relative.weights({"5", kPowerLaw, kOfLargeRows});
  ASSERT_TRUE(weights);
  const double value = 2 * elementary::exp(1.5 * elementary::log(relative.x[3])) / relative.y[3];
  EXPECT_NEAR((*weights)[3] * value * value, 1, 1e-12);
  EXPECT_FALSE(NoisyLaw(0, 1).weights({"5", kPowerLaw, kOfLargeRows}));
}

TEST(RelativeNoise, IsNotLookedForInExactFormulas) {
  EXPECT_FALSE(NoisyLaw(0, 0).weights({"5", "2*x^1.5/y", "2.1*x^1.5/y"}));
}

TEST(RelativeNoise, IsNotOfALawThatGoesThroughZero) {
  NoisyLaw law(0, 0);
  RandomStream random(3);
  for (std::size_t r = 0; r < law.target.size(); ++r) {
    law.target[r] = (law.x[r] - 5) * (1 + 0.05 * random.normal()) + 0.5 * random.normal();
  }
  EXPECT_FALSE(law.weights({"5", "x - 5"}));
}

TEST(RelativeNoise, IsNotWhatAMissingTermLeaves) {
  const NoisyLaw law(0.02, 0);
  EXPECT_TRUE(leaves_only_noise(parse(kPowerLaw, kInputsOfLaw), law.inputs(), law.target));
  EXPECT_FALSE(leaves_only_noise(parse("2*x^1.6/y", kInputsOfLaw), law.inputs(), law.target));
}

}  // namespace
}  // namespace tribench
