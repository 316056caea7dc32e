// SPDX-License-Identifier: MIT
#include "algorithms/fitting/crossed_rows.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// 60 rows of x + y under noise; where x is large y is, too. s: the sign of x - 1.
class CrossedRowsTest : public ::testing::Test {
 protected:
  CrossedRowsTest() {
    RandomStream random(5);
    for (int r = 0; r < 60; ++r) {
      x_.push_back(random.uniform(0, 2));
      y_.push_back(x_.back() + random.uniform(0, 0.2));
      s_.push_back(x_.back() < 1 ? -1 : 1);
      target_.push_back(x_.back() + y_.back() + 0.1 * random.normal());
    }
    columns_ = {x_.data(), y_.data(), s_.data()};
  }
  bool strays(const std::string& formula, bool knows_the_sign = false) {
    InputBox box = {{0, 2}, {0, 3}, {-1, 1}};
    if (knows_the_sign) box[2].sign_of = 0;
    return CrossedRows({columns_, target_.size()}, target_, box).strays(parse(formula, kNames));
  }

  const std::vector<std::string> kNames = {"x", "y", "s"};
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> s_;
  std::vector<double> target_;
  std::vector<const double*> columns_;
};

TEST_F(CrossedRowsTest, APowerThatOneRowNeedsHasHugeValuesElsewhere) {
  EXPECT_TRUE(strays("x + y + 1e-15*x^60*exp(-9*y^2)"));
  EXPECT_TRUE(strays("x + y + exp(40*(x - y))"));
}

TEST_F(CrossedRowsTest, WhatStaysNearTheTargetDoesNotStray) {
  for (const char* formula : {"1", "x + y", "2*y", "x*y + 1", "x^3 - y", "9*(x - y)"}) {
    EXPECT_FALSE(strays(formula)) << formula;
  }
}

// A root of what hangs together has no value where it is taken apart: that says nothing.
TEST_F(CrossedRowsTest, NoValueIsNoHugeValue) { EXPECT_FALSE(strays("2*x + sqrt(y - x)")); }

// s x >= 0 on all rows, and at crossed ones where the sign goes with its x.
TEST_F(CrossedRowsTest, SignsGoWithWhatTheyAreTheSignsOf) {
  const std::string falls = "2*x + exp(-9*s*(x - 1))";
  EXPECT_TRUE(strays(falls));
  EXPECT_FALSE(strays(falls, true));
}

}  // namespace
}  // namespace tribench
