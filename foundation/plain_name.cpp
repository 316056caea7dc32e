// SPDX-License-Identifier: MIT
#include "foundation/plain_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr std::size_t kLongest = 64;

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

// What can be shown of a name that may hold anything.
std::string shown(std::string_view name) {
  std::string text(name.substr(0, kLongest));
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text + (name.size() > kLongest ? "..." : "");
}

}  // namespace

bool is_plain_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongest && is_letter_or_digit(name.front()) &&
         std::ranges::all_of(name, [](char c) {
           return is_letter_or_digit(c) || c == '_' || c == '.' || c == '+' || c == '-';
         });
}

void require_plain_name(std::string_view name, std::string_view what, std::string_view place) {
  if (is_plain_name(name)) return;
  throw_bad_input(
      fmt::format("'{}' cannot name {}", shown(name), what), place,
      fmt::format("use 1 to {} of letters, digits, _ . + -, a letter or digit first", kLongest));
}

}  // namespace tribench
