// SPDX-License-Identifier: MIT
#include "problems/reading/text_encoding.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tribench {
namespace {

// As a spreadsheet on a Chinese Windows writes it: time [s], position [deg], torque [Nm].
TEST(TextEncoding, ChineseNamesAreReadFromTheCodeOfTheirCountry) {
  EXPECT_EQ(
      as_utf8("\xCA\xB1\xBC\xE4 [s],\xCE\xBB\xD6\xC3 [\xA1\xE3],\xC1\xA6\xBE\xD8 [Nm]\n0,1,2\n"),
      "时间 [s],位置 [°],力矩 [Nm]\n0,1,2\n");
}

// The second byte of a Japanese character may be an ASCII letter or a backslash.
TEST(TextEncoding, JapaneseNamesAreReadFromTheCodeOfTheirCountry) {
  EXPECT_EQ(
      as_utf8("\x8E\x9E\x8A\xD4 [s],\x91\xAC\x93\x78,\x83\x67\x83\x8B\x83\x4E,\x94\x5C\x97\xCD\n"),
      "時間 [s],速度,トルク,能力\n");
}

TEST(TextEncoding, AccentsDegreesAndQuotationMarksAreLatin1) {
  EXPECT_EQ(as_utf8("Gr\xF6\xDF"
                    "e,Winkel [\xB0],\xDC"
                    "bersetzung\n"),
            "Größe,Winkel [°],Übersetzung\n");
  EXPECT_EQ(as_utf8("position [\xB0],speed [\xB0/s]\n"), "position [°],speed [°/s]\n");
  EXPECT_EQ(as_utf8("\xC1ngulo,posici\xF3n\n"), "Ángulo,posición\n");
  // Pairs of the Chinese code, but none beside another.
  EXPECT_EQ(as_utf8("\xC4\xDC,\xD6\xD6\n"), "ÄÜ,ÖÖ\n");
  // Windows' curved quotation marks, each with the letter behind it a pair of the Japanese code.
  EXPECT_EQ(as_utf8("the motor\x92s,\x93t\n"), "the motor\xC2\x92s,\xC2\x93t\n");
}

TEST(TextEncoding, WhatIsUtf8OrHasTheMarkOfUtf16IsReadAsThat) {
  EXPECT_EQ(as_utf8("时间,v\n"), "时间,v\n");
  EXPECT_EQ(as_utf8(std::string("\xFF\xFE"
                                "v\0",
                                4) +
                    std::string("\x65\x51", 2)),
            "v入");
}

// A character that is cut off is none of a code's.
TEST(TextEncoding, HalfACharacterMakesItLatin1) {
  EXPECT_EQ(as_utf8("\xCA\xB1\xBC\xE4,\xCE"), "Ê±¼ä,Î");
}

}  // namespace
}  // namespace tribench
