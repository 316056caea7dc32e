// SPDX-License-Identifier: MIT
#include "foundation/glob.hpp"

#include <gtest/gtest.h>

namespace tribench {
namespace {

TEST(GlobMatches, KnowsStarsAndQuestionMarks) {
  EXPECT_TRUE(glob_matches("*", ""));
  EXPECT_TRUE(glob_matches("A/*/load", "A/j2/load"));
  EXPECT_TRUE(glob_matches("a*b*c", "aXbYbZc"));
  EXPECT_FALSE(glob_matches("a?c", "ac"));
  EXPECT_FALSE(glob_matches("A/*/load", "A/j2/no_loads"));
}

}  // namespace
}  // namespace tribench
