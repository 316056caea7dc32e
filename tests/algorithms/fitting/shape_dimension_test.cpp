// SPDX-License-Identifier: MIT
#include "algorithms/fitting/shape_dimension.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

std::size_t dimension(const char* text) {
  return shape_dimension(parse(text, std::vector<std::string>{"v", "s"}));
}

TEST(ShapeDimension, CountsTheTermsOfALineWhateverTheirCoefficients) {
  EXPECT_EQ(dimension("2"), 1U);
  EXPECT_EQ(dimension("v"), 1U);
  EXPECT_EQ(dimension("3*v"), 1U);
  EXPECT_EQ(dimension("3*v + 2*s + 1"), 3U);
  EXPECT_EQ(dimension("v + s + 1"), 3U);
  EXPECT_EQ(dimension("2*(v + 0.5*s + 1)"), 3U);
}

TEST(ShapeDimension, CountsAScaleOnce) {
  EXPECT_EQ(dimension("2*(3*v)"), 1U);
  EXPECT_EQ(dimension("(2*v + 1)*(3*s + 4)"), 3U);
  EXPECT_EQ(dimension("v/(s + 2)"), 2U);
  EXPECT_EQ(dimension("sqrt(2*v^2)"), 1U);
  EXPECT_EQ(dimension("2*abs(3*v + 1)"), 2U);
  EXPECT_EQ(dimension("v^2 + v^3"), 2U);
}

TEST(ShapeDimension, OfAnExponentialHasItsScaleAndItsArgument) {
  EXPECT_EQ(dimension("exp(v)"), 2U);
  EXPECT_EQ(dimension("2*exp(3*v)"), 2U);
  EXPECT_EQ(dimension("2*exp(3*v + 1)"), 2U);          // exp(1) is a scale
  EXPECT_EQ(dimension("exp(2*(v + 1)*(s + 3))"), 4U);  // the offset 3 belongs to v as well
  EXPECT_EQ(dimension("exp(2*(v + 1))"), 2U);
  // The peer problem's law, and one with two coefficients that happen to be 1.
  EXPECT_EQ(dimension("(3.7*v + 8.5*s - 0.4)*exp(-0.8*v^2 + 1.3*v*s + 0.02*v)"), 6U);
  EXPECT_EQ(dimension("(v + 8.5*s - 0.4)*exp(-0.8*v^2 + v*s + 0.02*v)"), 6U);
}

TEST(ShapeDimension, DoesNotFreeAnExponentThatIsWritten) {
  EXPECT_EQ(dimension("(v + 2)^3"), 2U);
  EXPECT_EQ(dimension("2^v"), 2U);
}

TEST(ShapeDimension, DoesNotDependOnTheWayAFormulaIsBracketed) {
  EXPECT_EQ(dimension("v*(s*(v + 1))"), dimension("(v*s)*(v + 1)"));
  EXPECT_EQ(dimension("(1 + v) + (2 + s)"), dimension("3 + v + s"));
}

}  // namespace
}  // namespace tribench
