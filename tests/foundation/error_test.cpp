// SPDX-License-Identifier: MIT
#include "foundation/error.hpp"

#include <gtest/gtest.h>

namespace tribench {
namespace {

TEST(Error, SaysWhereWhatAndHowToMendIt) {
  const Error error(ErrorKind::bad_input, "the cell is empty", "a.csv:3:2", "fill it");
  EXPECT_STREQ(error.what(), "a.csv:3:2: the cell is empty; fill it");
  EXPECT_EQ(error.kind(), ErrorKind::bad_input);
}

TEST(NearestName, FindsATypoAndNothingWhenNothingIsNear) {
  const std::vector<std::string> names = {"symmetric", "asymmetric", "pysr"};
  EXPECT_EQ(nearest_name("symetric", names), "symmetric");
  EXPECT_EQ(nearest_name("pyrs", names), "pysr");
  EXPECT_EQ(nearest_name("zzzzzzzz", names), "");
}

}  // namespace
}  // namespace tribench
