// SPDX-License-Identifier: MIT
//
// JSON from outside, and JSON for outside. Reading is bounded: what nests deeper than kMaxJsonDepth
// is refused, because writing, comparing and walking a value are recursive and would run out of
// stack, and so is an object in which a key stands twice, of which readers would take one or the
// other. Writing never throws: bytes that are no UTF-8 become U+FFFD.
//
// Every text that this process did not make itself (certificates, run folders, lines of external
// methods, weights, parameters) is read here.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace tribench {

inline constexpr int kMaxJsonDepth = 64;

// The value, or a discarded one (is_discarded()) where the text is not JSON or is refused as above;
// `reason` then says why in one line of printable text, with the line and column, and the word
// there (NaN), or with the key that stands twice.
template <typename Json>
Json read_json(std::string_view text, std::string* reason = nullptr);

// As above; throws Error (bad_input) with the place instead.
template <typename Json>
Json read_json_or_throw(std::string_view text, std::string_view place);

// Among whatever else a program prints: where, from `from` on, a line begins with '{', blanks
// aside; npos where none does.
std::size_t find_json_object(std::string_view text, std::size_t from);

// The object or array that begins at `at`, over as many lines as it takes and whatever follows it;
// as read_json otherwise. `at` moves on to where the reading ended, so that reading all of a text
// costs as much as the text is long.
template <typename Json>
Json read_json_at(std::string_view text, std::size_t& at, std::string* reason = nullptr);

// The whole number, where the value is one that Whole holds. get<Whole>() makes any number of 1e77,
// of 2.5 and of one with more digits.
template <std::integral Whole, typename Json>
std::optional<Whole> json_whole_number(const Json& value) {
  const auto held = [](auto number) {
    return std::in_range<Whole>(number) ? std::optional(static_cast<Whole>(number)) : std::nullopt;
  };
  if (value.is_number_unsigned()) return held(value.template get<std::uint64_t>());
  if (value.is_number_integer()) return held(value.template get<std::int64_t>());
  return std::nullopt;
}

// What the library says of a value that is not there or of another type ("key 'verdict' not
// found"), without the library's own numbers.
std::string json_complaint(const nlohmann::detail::exception& error);

// null where the value is not finite.
nlohmann::ordered_json json_number(double value);

// On one line where indent is negative.
template <typename Json>
std::string write_json(const Json& value, int indent = -1);

extern template nlohmann::json read_json(std::string_view, std::string*);
extern template nlohmann::ordered_json read_json(std::string_view, std::string*);
extern template nlohmann::json read_json_at(std::string_view, std::size_t&, std::string*);
extern template nlohmann::ordered_json read_json_at(std::string_view, std::size_t&, std::string*);
extern template nlohmann::json read_json_or_throw(std::string_view, std::string_view);
extern template nlohmann::ordered_json read_json_or_throw(std::string_view, std::string_view);
extern template std::string write_json(const nlohmann::json&, int);
extern template std::string write_json(const nlohmann::ordered_json&, int);

}  // namespace tribench
