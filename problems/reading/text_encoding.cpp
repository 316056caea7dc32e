// SPDX-License-Identifier: MIT
#include "problems/reading/text_encoding.hpp"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "foundation/text.hpp"

namespace tribench {
namespace {

void append_utf8(std::string& out, std::uint32_t code) {
  const auto byte = [&](std::uint32_t value) { out += static_cast<char>(value); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | (code >> 6));
    byte(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    byte(0xE0 | (code >> 12));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  } else {
    byte(0xF0 | (code >> 18));
    byte(0x80 | ((code >> 12) & 0x3F));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

// Spreadsheets' "Unicode text". A lone half of a pair becomes the sign of replacement.
std::string from_utf16(std::string_view bytes, bool high_first) {
  std::string out;
  out.reserve(bytes.size() / 2);
  const auto unit = [&](std::size_t at) -> std::uint32_t {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return high_first ? first << 8U | second : second << 8U | first;
  };
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {  // behind the mark
    std::uint32_t code = unit(at);
    const bool leads = code >= 0xD800 && code < 0xDC00 && at + 3 < bytes.size();
    if (leads && unit(at + 2) >= 0xDC00 && unit(at + 2) < 0xE000) {
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(at + 2) - 0xDC00);
      at += 2;
    }
    append_utf8(out, code >= 0xD800 && code < 0xE000 ? 0xFFFD : code);
  }
  return out;
}

// From the first to the last.
struct Bytes {
  unsigned char first;
  unsigned char last;
};

bool holds(std::span<const Bytes> ranges, unsigned char byte) {
  return std::ranges::any_of(
      ranges, [&](const Bytes& range) { return byte >= range.first && byte <= range.last; });
}

// A code whose characters beyond ASCII are pairs of bytes: those that names are written with.
struct PairCode {
  const char* name;               // iconv's
  std::span<const Bytes> words;   // first bytes: syllables and the usual ideographs
  std::span<const Bytes> signs;   // first bytes: degree signs, wide letters
  std::span<const Bytes> second;  // second bytes
};

constexpr std::array<Bytes, 1> kChineseWords = {{{0xB0, 0xD7}}};
constexpr std::array<Bytes, 1> kChineseSigns = {{{0xA1, 0xA9}}};
constexpr std::array<Bytes, 1> kChineseSecond = {{{0xA1, 0xFE}}};
constexpr std::array<Bytes, 2> kJapaneseWords = {{{0x82, 0x83}, {0x88, 0x98}}};
constexpr std::array<Bytes, 3> kJapaneseSigns = {{{0x81, 0x81}, {0x84, 0x84}, {0x87, 0x87}}};
constexpr std::array<Bytes, 2> kJapaneseSecond = {{{0x40, 0x7E}, {0x80, 0xFC}}};
constexpr std::array<PairCode, 2> kPairCodes = {
    {{"GB18030", kChineseWords, kChineseSigns, kChineseSecond},
     {"CP932", kJapaneseWords, kJapaneseSigns, kJapaneseSecond}}};

// Whether every byte beyond ASCII belongs to such a pair, and two that stand for words stand side
// by side: accents and curved quotation marks of Latin-1 stand alone.
bool is_written_in(const PairCode& code, std::string_view text) {
  constexpr std::size_t kSideBySide = 2;
  std::size_t words = 0;
  std::size_t most = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto first = static_cast<unsigned char>(text[at]);
    const bool is_word = holds(code.words, first);
    words = is_word ? words + 1 : 0;
    most = std::max(most, words);
    if (first < 0x80) continue;
    if (!is_word && !holds(code.signs, first)) return false;
    if (++at == text.size() || !holds(code.second, static_cast<unsigned char>(text[at]))) {
      return false;
    }
  }
  return most >= kSideBySide;
}

// Empty where this machine does not know the code, or the text is none.
std::string converted(std::string text, const char* code) {
  const iconv_t conversion = iconv_open("UTF-8", code);
  if (reinterpret_cast<std::intptr_t>(conversion) == -1) return {};
  std::string out(2 * text.size(), '\0');  // pairs become three bytes
  char* from = text.data();
  char* to = out.data();
  std::size_t left = text.size();
  std::size_t room = out.size();
  const bool is_whole =
      iconv(conversion, &from, &left, &to, &room) != static_cast<std::size_t>(-1) && left == 0;
  iconv_close(conversion);
  out.resize(out.size() - room);
  return is_whole ? out : std::string();
}

std::string from_latin_1(std::string_view text) {
  std::string out;
  for (const char c : text) append_utf8(out, static_cast<unsigned char>(c));
  return out;
}

}  // namespace

std::string as_utf8(std::string text) {
  if (text.starts_with("\xFF\xFE")) return from_utf16(text, false);
  if (text.starts_with("\xFE\xFF")) return from_utf16(text, true);
  if (is_utf8(text)) return text;
  for (const PairCode& code : kPairCodes) {
    if (!is_written_in(code, text)) continue;
    std::string out = converted(text, code.name);
    if (!out.empty()) return out;
  }
  return from_latin_1(text);
}

}  // namespace tribench
