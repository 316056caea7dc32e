// SPDX-License-Identifier: MIT
#include "foundation/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "foundation/error.hpp"

namespace tribench {
namespace {

// Builds the value from what the parser meets. The library's own reading with a callback, which
// could bound the depth too, looks at every element of a list again after each of them.
template <typename Json>
class JsonBuilder : public nlohmann::json_sax<Json> {
 public:
  // first, where wanted: the object or array in front, once closed.
  explicit JsonBuilder(Json* first) : first_(first) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(std::int64_t value) override { return add(value); }
  bool number_unsigned(std::uint64_t value) override { return add(value); }
  bool number_float(double value, const std::string&) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(typename Json::binary_t&) override { return false; }  // no part of the text
  bool start_object(std::size_t) override { return open(Json::value_t::object); }
  bool start_array(std::size_t) override { return open(Json::value_t::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    auto& object = open_.back()->template get_ref<typename Json::object_t&>();
    const std::size_t before = object.size();
    std::string read = name;  // below it may be moved into the object
    place_ = &member(object, name);
    if (object.size() == before) repeated_key_ = std::move(read);
    return !repeated_key_;
  }
  bool parse_error(std::size_t, const std::string&,
                   const nlohmann::detail::exception& error) override {
    const auto* wrong = dynamic_cast<const nlohmann::detail::parse_error*>(&error);
    if (wrong != nullptr) wrong_at_ = wrong->byte;
    return false;
  }

  Json take() { return std::move(root_); }
  bool is_too_deep() const { return is_too_deep_; }
  const std::optional<std::string>& repeated_key() const { return repeated_key_; }
  // The byte, from 1, at which the text is no JSON; none for a number that no double holds.
  std::optional<std::size_t> wrong_at() const { return wrong_at_; }

 private:
  // The library's ordered object compares a key with all before it.
  Json& member(typename Json::object_t& object, std::string& name) {
    constexpr std::size_t kFew = 16;
    if constexpr (std::is_same_v<Json, nlohmann::ordered_json>) {
      if (object.size() >= kFew) {
        std::unordered_map<std::string, std::size_t>& places = places_.back();
        for (std::size_t i = places.size(); i < object.size(); ++i) {
          places.emplace((object.begin() + static_cast<std::ptrdiff_t>(i))->first, i);
        }
        const auto [place, is_new] = places.try_emplace(name, object.size());
        if (is_new) object.emplace_back(std::move(name), nullptr);
        return (object.begin() + static_cast<std::ptrdiff_t>(place->second))->second;
      }
    }
    return object[name];
  }
  // In its place: behind a key, at the end of a list, or all there is.
  Json* put(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back()->is_object()) {
      *place_ = std::move(value);
      return place_;
    }
    open_.back()->push_back(std::move(value));
    return &open_.back()->back();
  }
  bool add(Json value) {
    put(std::move(value));
    return true;
  }
  bool open(typename Json::value_t kind) {
    is_too_deep_ = open_.size() >= static_cast<std::size_t>(kMaxJsonDepth);
    if (is_too_deep_) return false;
    open_.push_back(put(Json(kind)));
    places_.emplace_back();
    return true;
  }
  bool close() {
    open_.pop_back();
    places_.pop_back();
    if (open_.empty() && first_ != nullptr) *first_ = std::move(root_);
    return true;
  }

  Json* first_;
  Json root_ = Json(Json::value_t::discarded);
  std::vector<Json*> open_;  // each the last of the one before it, which does not grow meanwhile
  // Of each open object: where its keys stand, once they are many.
  std::vector<std::unordered_map<std::string, std::size_t>> places_;
  Json* place_ = nullptr;  // of the key read last
  bool is_too_deep_ = false;
  std::optional<std::string> repeated_key_;
  std::optional<std::size_t> wrong_at_;
};

constexpr std::size_t kLongestWord = 20;  // that is quoted
constexpr std::size_t kLongestKey = 60;   // the same, in bytes

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

// The text from `at` on, which moves to where the reading ended; `first` as above.
template <typename Json>
Json parse_from(std::string_view text, std::size_t& at, Json* first, std::string* reason) {
  const auto refuse = [reason](std::string why) {
    if (reason != nullptr) *reason = std::move(why);
    return Json(Json::value_t::discarded);
  };
  const std::size_t begin = at;
  JsonBuilder<Json> builder(first);
  if (Json::sax_parse(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(), &builder)) {
    at = text.size();
    return builder.take();
  }
  if (builder.is_too_deep()) {
    return refuse(fmt::format("JSON nested deeper than {} levels", kMaxJsonDepth));
  }
  if (builder.repeated_key()) {
    const std::string key = builder.repeated_key()->substr(0, kLongestKey);
    return refuse(fmt::format("the key {} stands twice in one object", write_json(Json(key))));
  }
  const std::optional<std::size_t> byte = builder.wrong_at();
  if (!byte) return refuse("a number out of range in JSON");
  at = std::min(begin + std::max<std::size_t>(*byte, 1) - 1, text.size());
  if (reason == nullptr) return refuse({});  // lines are not counted for nobody
  return refuse("no JSON at " + place_in(text, begin + *byte) + word_in(text, at));
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
