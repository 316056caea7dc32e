// SPDX-License-Identifier: MIT
//
// Numbers as people type them, read strictly: the whole text is a finite number of the kind and in
// its range, or it is none. For command lines, parameters and small grammars; data files have a
// reader of their own (millions of cells, decimal commas), formulas too.
//
// Accepted: an optional sign, decimal digits, a point, an exponent. Not accepted: blanks, hex,
// octal, separators of thousands, nan, inf. A whole number may be written as 1e9 or 2.5e3.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tribench {

namespace number_text {
std::optional<double> read_real(std::string_view text);
std::optional<std::int64_t> read_signed(std::string_view text);
std::optional<std::uint64_t> read_unsigned(std::string_view text);
}  // namespace number_text

// Nothing where the text is no such number. Cost: one pass.
template <typename Number>
std::optional<Number> read_number(std::string_view text) {
  if constexpr (std::floating_point<Number>) {
    const std::optional<double> real = number_text::read_real(text);
    return real ? std::optional<Number>(static_cast<Number>(*real)) : std::nullopt;
  } else if constexpr (std::signed_integral<Number>) {
    const std::optional<std::int64_t> whole = number_text::read_signed(text);
    const bool fits = whole && static_cast<std::int64_t>(static_cast<Number>(*whole)) == *whole;
    return fits ? std::optional<Number>(static_cast<Number>(*whole)) : std::nullopt;
  } else {
    const std::optional<std::uint64_t> whole = number_text::read_unsigned(text);
    const bool fits = whole && static_cast<std::uint64_t>(static_cast<Number>(*whole)) == *whole;
    return fits ? std::optional<Number>(static_cast<Number>(*whole)) : std::nullopt;
  }
}

}  // namespace tribench
