// SPDX-License-Identifier: MIT
#include "foundation/error.hpp"

#include <fmt/format.h>

namespace tribench {
namespace {

// A message quotes what it is about, and that may be as long as a file.
constexpr std::size_t kLongest = 4000;  // bytes
constexpr std::size_t kKeptEnd = 800;

bool continues_a_letter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

std::string shortened(std::string text) {
  if (text.size() <= kLongest) return text;
  std::size_t begin = kLongest - kKeptEnd;
  std::size_t end = text.size() - kKeptEnd;
  while (begin > 0 && continues_a_letter(text[begin])) --begin;
  while (end < text.size() && continues_a_letter(text[end])) ++end;
  return fmt::format("{} [{} bytes] {}", text.substr(0, begin), end - begin, text.substr(end));
}

std::string compose(std::string_view what, std::string_view place, std::string_view mend) {
  std::string text = place.empty() ? std::string(what) : fmt::format("{}: {}", place, what);
  if (!mend.empty()) text += fmt::format("; {}", mend);
  return shortened(std::move(text));
}

}  // namespace

Error::Error(ErrorKind kind, std::string_view what, std::string_view place, std::string_view mend)
    : std::runtime_error(compose(what, place, mend)), kind_(kind), place_(place), mend_(mend) {}

void throw_bad_input(std::string_view what, std::string_view place, std::string_view mend) {
  throw Error(ErrorKind::bad_input, what, place, mend);
}

}  // namespace tribench
