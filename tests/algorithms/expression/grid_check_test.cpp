// SPDX-License-Identifier: MIT
#include "algorithms/expression/grid_check.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench::grid_check_test {
namespace {

const std::vector<std::string> kNames = {"v", "sgn_v", "g"};
const InputBox kBox = {{-2, 2}, {-1, 1, 0}, {-60, 60}};

bool is_seen(const std::string& formula) {
  return !is_finite_on_grid(parse(formula, kNames), kBox);
}

TEST(GridCheck, SeesWhatLiesOnItsPointsAndMissesWhatLiesBetween) {
  EXPECT_TRUE(is_seen("1/v"));
  EXPECT_TRUE(is_seen("sqrt(v)"));
  EXPECT_TRUE(is_seen("1/(sgn_v + 1)"));
  EXPECT_TRUE(is_seen("1/(v*g)"));
  EXPECT_FALSE(is_seen("1/(v - 0.30001)"));
  EXPECT_FALSE(is_seen("1/(v^2 - 2)"));
  EXPECT_FALSE(is_seen("v + g"));
  EXPECT_FALSE(is_seen("3"));
}

TEST(GridCheck, NeverSeesWhatIsProvedFree) {
  for (const char* text : {"1/(v^2 + 1)", "sqrt(v*sgn_v)", "g/(2 + sgn_v)", "exp(11*g)"}) {
    ASSERT_EQ(prove_free(parse(text, kNames), kBox).verdict, Verdict::proved_free);
    EXPECT_FALSE(is_seen(text));
  }
}

}  // namespace
}  // namespace tribench::grid_check_test
