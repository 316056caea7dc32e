// SPDX-License-Identifier: MIT
#include "foundation/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"

namespace tribench {
namespace {

// Stops the parser: a callback that answers `false` would let it read on.
struct TooDeep {};

constexpr std::size_t kLongestWord = 20;  // that is quoted

std::string place_in(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = std::ranges::count(before, '\n') + 1;
  const std::size_t start = before.rfind('\n');
  const std::size_t column = start == std::string_view::npos ? before.size() : byte - start - 1;
  return fmt::format("line {}, column {}", line, std::max<std::size_t>(column, 1));
}

// In brackets: NaN, which JSON has not and many programs print, says more than its place.
std::string word_in(std::string_view text, std::size_t at) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (at >= text.size() || !is_letter(text[at])) return {};
  std::size_t begin = at;
  while (begin > 0 && at - begin < kLongestWord && is_letter(text[begin - 1])) --begin;
  std::size_t end = at;
  while (end < text.size() && end - begin < kLongestWord && is_letter(text[end])) ++end;
  return fmt::format(" ({})", text.substr(begin, end - begin));
}

// The text from `at` on, which moves to where the reading ended. `first`, where wanted: the object
// or array in front, once closed.
template <typename Json>
Json parse_from(std::string_view text, std::size_t& at, Json* first, std::string* reason) {
  const auto refuse = [reason](std::string why) {
    if (reason != nullptr) *reason = std::move(why);
    return Json(Json::value_t::discarded);
  };
  // An object or array at depth d is announced with d open around it.
  const auto bounded = [first](int depth, typename Json::parse_event_t event, Json& value) {
    using Event = typename Json::parse_event_t;
    const bool opens = event == Event::object_start || event == Event::array_start;
    const bool closes = event == Event::object_end || event == Event::array_end;
    if (opens && depth >= kMaxJsonDepth) throw TooDeep();
    if (closes && depth == 0 && first != nullptr) *first = std::move(value);
    return true;
  };
  const std::size_t begin = at;
  try {
    Json all = Json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(), bounded);
    at = text.size();
    return all;
  } catch (const TooDeep&) {
    return refuse(fmt::format("JSON nested deeper than {} levels", kMaxJsonDepth));
  } catch (const nlohmann::detail::parse_error& error) {
    at = std::min(begin + std::max<std::size_t>(error.byte, 1) - 1, text.size());
    if (reason == nullptr) return refuse({});  // lines are not counted for nobody
    return refuse("no JSON at " + place_in(text, begin + error.byte) + word_in(text, at));
  } catch (const nlohmann::detail::exception&) {  // a number that no double holds
    return refuse("a number out of range in JSON");
  }
}

}  // namespace

template <typename Json>
Json read_json(std::string_view text, std::string* reason) {
  // The parser takes a NUL byte for the end, and what stands behind it would be read by nobody.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    if (reason != nullptr) *reason = "a NUL byte, which JSON has not, at " + place_in(text, nul);
    return Json(Json::value_t::discarded);
  }
  std::size_t at = 0;
  return parse_from<Json>(text, at, nullptr, reason);
}

std::size_t find_json_object(std::string_view text, std::size_t from) {
  for (std::size_t at = text.find('{', from); at < text.size(); at = text.find('{', at + 1)) {
    const std::size_t before = text.substr(0, at).find_last_not_of(" \t\r");
    if (before == std::string_view::npos || text[before] == '\n') return at;
  }
  return std::string_view::npos;
}

template <typename Json>
Json read_json_at(std::string_view text, std::size_t& at, std::string* reason) {
  const std::size_t begin = at;
  Json first(Json::value_t::discarded);
  parse_from<Json>(text, at, &first, reason);
  at = std::max(at, std::min(begin + 1, text.size()));
  return first;
}

template <typename Json>
Json read_json_or_throw(std::string_view text, std::string_view place) {
  std::string reason;
  Json value = read_json<Json>(text, &reason);
  if (value.is_discarded()) throw_bad_input(reason, place);
  return value;
}

std::string json_complaint(const nlohmann::detail::exception& error) {
  const std::string_view said = error.what();
  const std::size_t end = said.starts_with('[') ? said.find("] ") : std::string_view::npos;
  return std::string(end == std::string_view::npos ? said : said.substr(end + 2));
}

nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

template <typename Json>
std::string write_json(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

template nlohmann::json read_json(std::string_view, std::string*);
template nlohmann::ordered_json read_json(std::string_view, std::string*);
template nlohmann::json read_json_at(std::string_view, std::size_t&, std::string*);
template nlohmann::ordered_json read_json_at(std::string_view, std::size_t&, std::string*);
template nlohmann::json read_json_or_throw(std::string_view, std::string_view);
template nlohmann::ordered_json read_json_or_throw(std::string_view, std::string_view);
template std::string write_json(const nlohmann::json&, int);
template std::string write_json(const nlohmann::ordered_json&, int);

}  // namespace tribench
