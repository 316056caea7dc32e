// SPDX-License-Identifier: MIT
//
// What stands in a cell or a heading and could be taken for something else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

// The nanoseconds of a whole stamp are no rest of the seconds beside them.
TEST(Csv, ASecondTimeOfItsOwnIsNotAddedToTheFirst) {
  const DataFile file = parse_csv(
      "t,stamp_ns,position [rad]\n0.0,1700000000999000000,0.1\n0.002,1700000001001000000,0.2\n"
      "0.004,1700000001003000000,0.3\n",
      "bag.csv");
  const Channel* time = file.data.find(Role::time);
  ASSERT_NE(time, nullptr);
  EXPECT_NEAR(time->values[2] - time->values[0], 0.004, 1e-6);
  EXPECT_LT(time->values[1] - time->values[0], 1);
}

// A spreadsheet breaks a heading into lines; a damaged file has what a terminal would obey.
TEST(Csv, NamesAndTextsHoldNoControlCharacters) {
  const DataFile file = parse_csv("\"Torque\n(Nm)\",\x1b[31mx,kind\n1,2,a\x07\n2,3,b\n", "log.csv",
                                  {.names_tell = false});
  ASSERT_EQ(file.data.channels.size(), 2U);
  EXPECT_EQ(file.data.channels[0].name, "Torque (Nm)");
  EXPECT_EQ(file.data.channels[1].name, "?[31mx");
  ASSERT_EQ(file.texts.size(), 1U);
  EXPECT_EQ(file.texts[0].values[0], "a?");
}

TEST(Csv, HexadecimalNumbersAreReadAndSaid) {
  const DataFile file = parse_csv("count,y\n0x0F,1\n0x10,2\n", "bus.csv", {.names_tell = false});
  EXPECT_EQ(file.data.at("count").values, (std::vector<double>{15, 16}));
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_THAT(file.warnings[0], HasSubstr("'count' holds hexadecimal numbers"));
}

}  // namespace
}  // namespace tribench
