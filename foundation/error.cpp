// SPDX-License-Identifier: MIT
#include "foundation/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace tribench {
namespace {

// A message quotes what it is about, and that may be as long as a file.
constexpr std::size_t kLongest = 4000;  // bytes
constexpr std::size_t kKeptEnd = 800;

constexpr std::size_t kLongestQuotation = 200;
constexpr std::size_t kKeptOfQuotation = 60;

bool continues_a_word(char byte) { return std::isalnum(static_cast<unsigned char>(byte)) != 0; }
bool continues_a_letter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

// The first byte at or before `at` with which a letter begins.
std::size_t begin_of_letter(std::string_view text, std::size_t at) {
  while (at > 0 && continues_a_letter(text[at])) --at;
  return at;
}

std::string shortened(std::string text) {
  if (text.size() <= kLongest) return text;
  const std::size_t begin = begin_of_letter(text, kLongest - kKeptEnd);
  std::size_t end = text.size() - kKeptEnd;
  while (end < text.size() && continues_a_letter(text[end])) ++end;
  return fmt::format("{} [{} bytes] {}", text.substr(0, begin), end - begin, text.substr(end));
}

// Where the quotation ends that begins before `from`: an apostrophe with no letter after it.
std::size_t end_of_quotation(std::string_view text, std::size_t from) {
  std::size_t end = text.find('\'', from);
  while (end != text.npos && end + 1 < text.size() && continues_a_word(text[end + 1])) {
    end = text.find('\'', end + 1);
  }
  return std::min(end, text.size());
}

// With the beginning of each long quotation, so that a cell of a megabyte does not hide the
// sentence.
std::string with_short_quotations(std::string_view text) {
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = text.find('\''); at != text.npos; at = text.find('\'', done)) {
    if (at > 0 && continues_a_word(text[at - 1])) {  // an apostrophe
      out += text.substr(done, at + 1 - done);
      done = at + 1;
      continue;
    }
    const std::size_t end = end_of_quotation(text, at + 1);
    const std::size_t kept =
        end - at - 1 <= kLongestQuotation ? end : begin_of_letter(text, at + 1 + kKeptOfQuotation);
    out += text.substr(done, kept - done);
    if (kept < end) out += fmt::format("... [{} bytes more]", end - kept);
    out += text.substr(end, 1);
    done = std::min(end + 1, text.size());
  }
  return out.append(text.substr(done));
}

std::string compose(std::string_view what, std::string_view place, std::string_view mend) {
  std::string text = with_short_quotations(what);
  if (!place.empty()) text = fmt::format("{}: {}", place, text);
  if (!mend.empty()) text += fmt::format("; {}", mend);
  return shortened(std::move(text));
}

}  // namespace

Error::Error(ErrorKind kind, std::string_view what, std::string_view place, std::string_view mend)
    : std::runtime_error(compose(what, place, mend)),
      kind_(kind),
      text_(what),
      place_(place),
      mend_(mend) {}

void throw_bad_input(std::string_view what, std::string_view place, std::string_view mend) {
  throw Error(ErrorKind::bad_input, what, place, mend);
}

}  // namespace tribench
