// SPDX-License-Identifier: MIT
//
// What stands in a cell or a heading and could be taken for something else.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
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

// As a spreadsheet shows a time: it starts again at the full hour, and counts on where it has room.
TEST(Csv, AClockOfMinutesGoesPastTheHour) {
  const auto times_of = [](const std::string& cells) {
    return parse_csv("time;q [deg]\n" + cells, "log.csv").data.find(Role::time)->values;
  };
  const std::vector<double> expected = {3599.8, 3599.9, 3600.1, 3600.2};
  EXPECT_THAT(times_of("59:59.8;1\n59:59.9;2\n00:00.1;3\n00:00.2;4\n"),
              ::testing::Pointwise(::testing::DoubleNear(1e-9), expected));
  EXPECT_THAT(times_of("59:59.8;1\n59:59.9;2\n60:00.1;3\n60:00.2;4\n"),
              ::testing::Pointwise(::testing::DoubleNear(1e-9), expected));
  std::string rows;  // one of them overtaken
  for (int i = 0; i < 60; ++i) {
    const int tenth = i == 30 ? 31 : i == 31 ? 30 : i;
    rows += tenth < 31 ? fmt::format("59:5{:.1f};1\n", 5 + 0.1 * tenth)
                       : fmt::format("00:0{:.1f};1\n", 0.1 * (tenth - 31));
  }
  const std::vector<double> sorted = times_of(rows);
  EXPECT_NEAR(sorted.back() - sorted.front(), 3602.8 - 3595, 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(sorted));
}

TEST(Csv, ThousandsAreReadWhereTheWholeFileTellsTheirSign) {
  const auto first_of = [](const std::string& rows) {
    return parse_csv("v\ty\n" + rows, "log.csv", {.names_tell = false}).data.at("v").values;
  };
  using Values = std::vector<double>;
  EXPECT_EQ(first_of("1,234.5\t1\n-0.5\t2\n"), (Values{1234.5, -0.5}));
  EXPECT_EQ(first_of("1.234,5\t1\n1.234\t2\n0,5\t3\n"), (Values{1234.5, 1234, 0.5}));
  EXPECT_EQ(first_of("1'234.5\t1\n999\t2\n"), (Values{1234.5, 999}));
  EXPECT_EQ(first_of("1\xE2\x80\x99"
                     "234.5\t1\n0\t2\n"),
            (Values{1234.5, 0}));
  EXPECT_EQ(first_of("-1 234 567,5\t1\n2\t2,5\n"), (Values{-1234567.5, 2}));
  EXPECT_EQ(first_of("1\xC2\xA0"
                     "234.5\t1\n3\t4\n"),
            (Values{1234.5, 3}));
  EXPECT_EQ(first_of("1,234,567\t1\n1,234\t2\n"), (Values{1234567, 1234}));
  const DataFile said = parse_csv("v;y\n1.234,5;1\n2,5;2\n", "log.csv", {.names_tell = false});
  EXPECT_THAT(
      said.warnings,
      ::testing::ElementsAre(HasSubstr("'.' parts the thousands: '1.234,5' is read as 1234.5")));
}

TEST(Csv, ThousandsThatMayBeReadInTwoWaysAreRefused) {
  const auto wrong = [](const std::string& rows) -> std::string {
    try {
      parse_csv("t\tv\n" + rows, "log.csv",
                {.roles = parse_roles("v=motor_torque[N m]", "--roles")});
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  for (const char* rows : {"0\t1,234.5\n1\t1.234,5\n", "0\t0.5\n0\t1'234.5\n1\t1,234.5\n",
                           "0\t0.5\n1\t12 34.5\n", "0\t0.5\n0\t0'234.5\n"}) {
    EXPECT_THAT(wrong(rows), AllOf(HasSubstr("log.csv:"), HasSubstr(":v: '"))) << rows;
  }
}

TEST(Csv, AnIndexWithoutANameMayBeTheTime) {
  const DataFile dates =
      parse_csv(",q [deg]\n2024-05-14 09:12:33.50,1\n2024-05-14 09:12:33.75,2\n", "log.csv");
  ASSERT_NE(dates.data.find(Role::time), nullptr);
  EXPECT_NEAR(dates.data.find(Role::time)->values[1] - dates.data.find(Role::time)->values[0], 0.25,
              1e-6);
  EXPECT_EQ(parse_csv(",q [deg]\n0,1\n1,2\n", "log.csv").data.find(Role::time), nullptr) << "rows";
}

// What looks like the first row may be a comment, and no row follows.
TEST(Csv, ADateWithoutARowIsNoTime) {
  EXPECT_THROW(parse_csv("date,v,w,x\n//a,0,1,2,3\n", "log.csv"), Error);
  EXPECT_THROW(parse_csv(",v,w,x\n//a,0,1,2,3\n", "log.csv"), Error);
}

TEST(Csv, AColumnThatIsSaidToBeNothingIsNotTakenByItsUnit) {
  CsvOptions options;
  options.roles = parse_roles("\"shoulder [deg]\"=none", "--roles");
  const DataFile file = parse_csv("t [s],shoulder [deg],i [A]\n0,1,2\n1,2,2\n", "log.csv", options);
  EXPECT_EQ(file.data.find(Role::position), nullptr);
}

}  // namespace
}  // namespace tribench
