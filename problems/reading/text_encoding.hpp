// SPDX-License-Identifier: MIT
//
// A data file's bytes as UTF-8: from UTF-16 where it has that mark; where it is no UTF-8, as
// spreadsheets write it where they run: from GB18030 (simplified Chinese) or Shift-JIS (Japanese)
// where all that is not ASCII is made of their usual characters, two of them side by side at least,
// else from Latin-1, which anything can be read as. Conversion is the C library's (iconv).
// Not for Big5 and Korean codes.
#pragma once

#include <string>

namespace tribench {

// Any bytes become valid UTF-8. Reads the text once, where it is none some times more.
std::string as_utf8(std::string text);

}  // namespace tribench
