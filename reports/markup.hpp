// SPDX-License-Identifier: MIT
//
// Text between tags or within quotes of HTML and XML. Control characters, which XML forbids, become
// blanks.
#pragma once

#include <string>
#include <string_view>

namespace tribench {

inline std::string markup_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c >= 0 && c < ' ' ? ' ' : c;
    }
  }
  return result;
}

}  // namespace tribench
