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

std::string place_in(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = std::ranges::count(before, '\n') + 1;
  const std::size_t start = before.rfind('\n');
  const std::size_t column = start == std::string_view::npos ? before.size() : byte - start - 1;
  return fmt::format("line {}, column {}", line, std::max<std::size_t>(column, 1));
}

}  // namespace

template <typename Json>
Json read_json(std::string_view text, std::string* reason) {
  const auto refuse = [reason](std::string why) {
    if (reason != nullptr) *reason = std::move(why);
    return Json(Json::value_t::discarded);
  };
  // An object or array at depth d is announced with d open around it.
  const auto bounded = [](int depth, typename Json::parse_event_t event, Json&) {
    using Event = typename Json::parse_event_t;
    const bool opens = event == Event::object_start || event == Event::array_start;
    if (opens && depth >= kMaxJsonDepth) throw TooDeep();
    return true;
  };
  try {
    return Json::parse(text.begin(), text.end(), bounded);
  } catch (const TooDeep&) {
    return refuse(fmt::format("JSON nested deeper than {} levels", kMaxJsonDepth));
  } catch (const nlohmann::detail::parse_error& error) {
    return refuse("no JSON at " + place_in(text, error.byte));
  } catch (const nlohmann::detail::exception&) {  // a number that no double holds
    return refuse("a number out of range in JSON");
  }
}

template <typename Json>
Json read_json_or_throw(std::string_view text, std::string_view place) {
  std::string reason;
  Json value = read_json<Json>(text, &reason);
  if (value.is_discarded()) throw_bad_input(reason, place);
  return value;
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
template nlohmann::json read_json_or_throw(std::string_view, std::string_view);
template nlohmann::ordered_json read_json_or_throw(std::string_view, std::string_view);
template std::string write_json(const nlohmann::json&, int);
template std::string write_json(const nlohmann::ordered_json&, int);

}  // namespace tribench
