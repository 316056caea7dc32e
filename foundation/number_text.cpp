// SPDX-License-Identifier: MIT
#include "foundation/number_text.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

namespace tribench::number_text {
namespace {

// One plus sign, which from_chars does not know.
std::string_view without_plus(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  return text;
}

template <typename Number>
std::optional<Number> whole_text(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && !text.empty() ? std::optional<Number>(value)
                                                              : std::nullopt;
}

// "1e9": as a double that is whole; `limit` is the power of two beyond the kind's last number.
template <typename Whole>
std::optional<Whole> whole_number(std::string_view text, double least, double limit) {
  text = without_plus(text);
  if (const auto plain = whole_text<Whole>(text)) return plain;
  // Digits alone that did not fit are beyond the range: rounding them to a double may bring them
  // in.
  if (text.find_first_of("eE.") == std::string_view::npos) return std::nullopt;
  const std::optional<double> real = read_real(text);
  if (!real || *real != std::floor(*real) || *real < least || *real >= limit) return std::nullopt;
  return static_cast<Whole>(*real);
}

}  // namespace

std::optional<double> read_real(std::string_view text) {
  const std::optional<double> real = whole_text<double>(without_plus(text));
  return real && std::isfinite(*real) ? real : std::nullopt;
}

std::optional<std::int64_t> read_signed(std::string_view text) {
  return whole_number<std::int64_t>(text, -0x1p63, 0x1p63);
}

std::optional<std::uint64_t> read_unsigned(std::string_view text) {
  return whole_number<std::uint64_t>(text, 0, 0x1p64);
}

}  // namespace tribench::number_text
