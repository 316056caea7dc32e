// SPDX-License-Identifier: MIT
#include "foundation/number_text.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace tribench {
namespace {

TEST(NumberText, ReadsWhatPeopleType) {
  EXPECT_EQ(read_number<double>("1.5e3"), 1500);
  EXPECT_EQ(read_number<double>("+.5"), 0.5);
  EXPECT_EQ(read_number<double>("-0.25"), -0.25);
  EXPECT_EQ(read_number<int>("-7"), -7);
  EXPECT_EQ(read_number<std::uint64_t>("1e11"), 100'000'000'000U);
  EXPECT_EQ(read_number<std::uint64_t>("2.5e3"), 2500U);
  EXPECT_EQ(read_number<std::uint64_t>("18446744073709551615"), UINT64_MAX);
  EXPECT_EQ(read_number<std::int64_t>("-9223372036854775808"), INT64_MIN);
}

TEST(NumberText, TakesTheWholeTextOrNothing) {
  for (const char* text : {"", " ", "1xyz", " 1", "1 ", "0x10", "1'000", "1_000", "nan", "inf",
                           "-inf", "1e999", "+-1", "++1", "--1", "1e", "1,5", "e5", "."}) {
    EXPECT_EQ(read_number<double>(text), std::nullopt) << text;
    EXPECT_EQ(read_number<std::int64_t>(text), std::nullopt) << text;
    EXPECT_EQ(read_number<std::uint64_t>(text), std::nullopt) << text;
  }
}

TEST(NumberText, RefusesWhatTheKindCannotHold) {
  EXPECT_EQ(read_number<int>("2147483648"), std::nullopt);
  EXPECT_EQ(read_number<int>("0.5"), std::nullopt);
  EXPECT_EQ(read_number<std::uint64_t>("-1"), std::nullopt);
  EXPECT_EQ(read_number<std::int64_t>("18446744073709551615"), std::nullopt);
  EXPECT_EQ(read_number<std::uint64_t>("18446744073709551616"), std::nullopt);
  EXPECT_EQ(read_number<std::uint64_t>("99999999999999999999"), std::nullopt);
  EXPECT_EQ(read_number<std::uint64_t>("1e20"), std::nullopt);
}

}  // namespace
}  // namespace tribench
