// SPDX-License-Identifier: MIT
#include "foundation/toml_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "foundation/error.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

std::string key_of_parts(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

// The parser takes them and dies of its own tables afterwards.
TEST(Toml, KeysOfManyPartsAreRefused) {
  for (const std::string text :
       {"[" + key_of_parts(100'000) + "]\n", "\n[[" + key_of_parts(100'000) + "]]\n",
        "x = 1\n" + key_of_parts(100'000) + " = 1\n", "x = {" + key_of_parts(18) + " = 1}\n"}) {
    try {
      parse_toml(text, "deep.toml");
      FAIL() << "read";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("parts"));
      EXPECT_THAT(error.place(), HasSubstr("deep.toml:"));
    }
  }
  EXPECT_NO_THROW(parse_toml("[" + key_of_parts(17) + "]\n", "deep.toml"));
}

TEST(Toml, DotsInTextsCommentsAndNumbersPartNothing) {
  const std::string dots(100, '.');
  const std::string text =
      "# it's " + dots + "\na = \"" + dots + "\\\"" + dots + "\"\nb = '" + dots +
      "'\nc = \"\"\"\n" + dots + "\"\n" + dots +
      "\"\"\"\nd = [1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5, 10.5, 11.5, 12.5, "
      "13.5, 14.5, 15.5, 16.5, 17.5, 18.5]\n";
  EXPECT_EQ(parse_toml(text, "dots.toml").size(), 4U);
}

TEST(Toml, WhereATableIsWantedItsKeysAreSaid) {
  const toml::table file = parse_toml("seeds = [1, 2]\n", "grid.toml");
  const TomlTable table(file, "grid.toml", "grid", {"seeds"});
  try {
    table.table("seeds", {"first", "count"});
    FAIL() << "read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("seeds = { first = ..., count = ... }"));
    EXPECT_EQ(error.place(), "grid.toml:1:9");
  }
}

}  // namespace
}  // namespace tribench
