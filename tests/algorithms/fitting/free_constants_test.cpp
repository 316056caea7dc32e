// SPDX-License-Identifier: MIT
#include "algorithms/fitting/free_constants.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

std::vector<double> free_values(const std::string& text) {
  const Expression formula = parse(text, std::vector<std::string>{"x"});
  std::vector<double> values;
  for (const std::size_t place : free_constants(formula)) {
    values.push_back(formula.node(place).value);
  }
  return values;
}

TEST(FreeConstants, AreAllButIntegerExponents) {
  EXPECT_EQ(free_values("3*x^2 + 5"), (std::vector<double>{3, 5}));
  EXPECT_EQ(free_values("3*x^1.5"), (std::vector<double>{3, 1.5}));
  EXPECT_EQ(free_values("2^x"), (std::vector<double>{2}));
  EXPECT_TRUE(free_values("x").empty());
}

TEST(SimpleExponents, AreTheNearestHalvesAndThirds) {
  EXPECT_EQ(nearest_simple_exponent(0.49), 0.5);
  EXPECT_EQ(nearest_simple_exponent(-1.02), -1);
  EXPECT_EQ(nearest_simple_exponent(0.65), 2.0 / 3);
  EXPECT_EQ(nearest_simple_exponent(0.1), 0);
  for (const double found : {0.49, 0.65, -3.3, 7.1}) {
    EXPECT_TRUE(is_simple_exponent(nearest_simple_exponent(found))) << found;
    EXPECT_FALSE(is_simple_exponent(found)) << found;
  }
}

}  // namespace
}  // namespace tribench
