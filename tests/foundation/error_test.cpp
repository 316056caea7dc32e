// SPDX-License-Identifier: MIT
#include "foundation/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace tribench {
namespace {

TEST(Error, SaysWhereWhatAndHowToMendIt) {
  const Error error(ErrorKind::bad_input, "the cell is empty", "a.csv:3:2", "fill it");
  EXPECT_STREQ(error.what(), "a.csv:3:2: the cell is empty; fill it");
  EXPECT_EQ(error.kind(), ErrorKind::bad_input);
}

TEST(Error, AMessageIsNotAsLongAsTheFileThatItQuotes) {
  std::string name;
  for (int i = 0; i < 100'000; ++i) name += "\u00e4";
  const std::string text = Error(ErrorKind::bad_input, name, "a.csv", "mend it").what();
  EXPECT_LT(text.size(), 5000U);
  EXPECT_TRUE(text.starts_with("a.csv: ")) << text;
  EXPECT_TRUE(text.ends_with("; mend it")) << text;
  EXPECT_EQ(std::ranges::count(text, '\xc3'), std::ranges::count(text, '\xa4'))
      << "a letter is cut";
}

}  // namespace
}  // namespace tribench
