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

}  // namespace
}  // namespace tribench
