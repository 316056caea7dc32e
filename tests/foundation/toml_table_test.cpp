// SPDX-License-Identifier: MIT
#include "foundation/toml_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "foundation/error.hpp"

namespace tribench {
namespace {

using ::testing::ElementsAre;
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

TEST(Toml, AWholeNumberIsWrittenTheSameAloneAndInAnArray) {
  const toml::table file = parse_toml("one = 1e3\nsome = [1e3, 7]\nbroken = [1.5]\n", "grid.toml");
  const TomlTable table(file, "grid.toml", "", {"one", "some", "broken"});
  std::uint64_t one = 0;
  std::vector<std::uint64_t> some;
  table.read("one", one);
  table.read("some", some);
  EXPECT_EQ(one, 1000U);
  EXPECT_THAT(some, ElementsAre(1000U, 7U));
  EXPECT_THROW(table.read("broken", some), Error);
}

TEST(Toml, TheLargestWholeNumberOfAFileIsReadAndLargerOnesAreToldOfIt) {
  const toml::table file =
      parse_toml("most = 9223372036854775807\nless = -1\nmore = 1e30\n", "grid.toml");
  const TomlTable table(file, "grid.toml", "", {"most", "less", "more"});
  std::uint64_t read = 0;
  table.read("most", read);
  EXPECT_EQ(read, 9223372036854775807U);
  for (const char* key : {"less", "more"}) {
    try {
      table.read(key, read);
      ADD_FAILURE() << key;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("not negative, up to 9223372036854775807"));
    }
  }
}

TEST(Toml, AValueOfAnotherKindIsRefusedWithWhatIsWanted) {
  const toml::table file = parse_toml("flag = 1\nname = [\"a\", 2]\nshare = 2\n", "grid.toml");
  const TomlTable table(file, "grid.toml", "[grid]", {"flag", "name", "share"});
  bool flag = false;
  std::vector<std::string> name;
  double share = 0;
  const auto said = [](auto read) -> std::string {
    try {
      read();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(said([&] { table.read("flag", flag); }), HasSubstr("must be true or false"));
  EXPECT_THAT(said([&] { table.read("name", name); }), HasSubstr("must be an array of texts"));
  EXPECT_THAT(said([&] { table.read("share", share, 0, 1); }),
              HasSubstr("must be a number from 0 to 1"));
}

}  // namespace
}  // namespace tribench
