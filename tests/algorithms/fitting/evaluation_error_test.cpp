// SPDX-License-Identifier: MIT
#include "algorithms/fitting/evaluation_error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"x"};

class EvaluationErrorTest : public ::testing::Test {
 protected:
  EvaluationErrorTest() {
    for (int r = 0; r < 200; ++r) {
      x_.push_back(0.1 + 0.02 * r);
      target_.push_back(3 - x_.back());
    }
    pointers_ = {x_.data()};
  }
  Inputs inputs() const { return {pointers_, x_.size()}; }

  std::vector<double> x_;
  std::vector<double> target_;
  std::vector<const double*> pointers_;
};

TEST_F(EvaluationErrorTest, TellsAStaircaseFromTheSameFormulaWithoutCancellation) {
  const Expression stairs =
      parse("34752283899936*(x + 1.07e-13 - x*(1.000000000000008 + 7.9e-14*exp(-x)))", kNames);
  EXPECT_TRUE(loses_its_digits(stairs, inputs(), target_));
  for (const char* plain : {"3*exp(-x) + 0.7", "x", "(x - 1)^2 + 1e6 - 1e6*x", "1e-9*x"}) {
    EXPECT_FALSE(loses_its_digits(parse(plain, kNames), inputs(), target_)) << plain;
  }
}

TEST_F(EvaluationErrorTest, HoldsNothingAgainstWhatItKnowsNothingOf) {
  EXPECT_FALSE(loses_its_digits(parse("sqrt(x - x)/0 + log(x - 5)", kNames), inputs(), target_));
}

TEST_F(EvaluationErrorTest, IsOfTheSizeOfRounding) {
  EXPECT_EQ(largest_evaluation_error(parse("x", kNames), inputs()), 0);
  const double error = largest_evaluation_error(parse("1e10 + x", kNames), inputs());
  EXPECT_GT(error, 5e-7);
  EXPECT_LT(error, 5e-6);
}

}  // namespace
}  // namespace tribench
