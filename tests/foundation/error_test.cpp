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

TEST(Error, QuotesTheBeginningOfALongValueAndStillSaysWhatIsWrong) {
  const std::string cell = "ab'c" + std::string(1'000'000, 'x');
  const auto said = [](const std::string& what) {
    return std::string(Error(ErrorKind::bad_input, what, "a.csv:52:v", "mend it").what());
  };
  const std::string text = said("the file's cell '" + cell + "' is no number, unlike '1.5'");
  EXPECT_LT(text.size(), 200U);
  EXPECT_TRUE(text.starts_with("a.csv:52:v: the file's cell 'ab'cxxx")) << text;
  EXPECT_TRUE(text.ends_with("xxx... [999944 bytes more]' is no number, unlike '1.5'; mend it"))
      << text;
  EXPECT_TRUE(said("'" + cell).ends_with("bytes more]; mend it"));  // a quotation without an end
  const std::string short_ones = "the users' 'first', the joint's 'second' and ''";
  EXPECT_EQ(said(short_ones), "a.csv:52:v: " + short_ones + "; mend it");
}

}  // namespace
}  // namespace tribench
