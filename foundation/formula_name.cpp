// SPDX-License-Identifier: MIT
#include "foundation/formula_name.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr std::string_view kSign = "sgn_";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool is_function(std::string_view name) {
  return std::ranges::find(kFunctionNames, name) != kFunctionNames.end();
}

// For an error message: neither control characters nor more than a line.
std::string shown(std::string_view name) {
  constexpr std::size_t kLongest = 60;
  std::string text;
  for (const char c : name.substr(0, kLongest)) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    text +=
        is_control ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return name.size() > kLongest ? text + "..." : text;
}

}  // namespace

bool is_identifier(std::string_view name) {
  return !name.empty() && is_letter(name[0]) &&
         std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c); });
}

bool is_formula_name(std::string_view name) {
  return is_identifier(name) && !is_function(name) && name != kSign;
}

std::string formula_name_for(std::string_view name) {
  std::string mended;
  for (const char c : name) {
    if (is_letter(c) || is_digit(c)) {
      mended += c;
    } else if (!mended.empty() && mended.back() != '_') {
      mended += '_';
    }
  }
  while (mended.size() > 1 && mended.back() == '_') mended.pop_back();
  if (mended.empty() || is_digit(mended[0])) mended.insert(0, 1, 'x');
  if (name == kSign) return "sgn_x";
  if (is_function(mended)) mended += '_';
  return mended;
}

void require_formula_name(std::string_view name, std::string_view place) {
  if (is_formula_name(name)) return;
  const std::string why = is_identifier(name) ? "is a function of formulas" : "is no identifier";
  throw_bad_input(fmt::format("'{}' cannot name an input of a formula: it {}", shown(name), why),
                  place,
                  fmt::format("call it {} (a letter or _, then letters, digits and _)",
                              formula_name_for(name)));
}

}  // namespace tribench
