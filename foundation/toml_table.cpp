// SPDX-License-Identifier: MIT
#include "foundation/toml_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace {

std::string place_of(const std::string& file, const toml::source_region& source) {
  if (source.begin.line == 0) return file;
  return fmt::format("{}:{}:{}", file, source.begin.line, source.begin.column);
}

// Where the text that begins at `begin` with its quote ends: behind the closing quote, or at the
// end.
std::size_t end_of_toml_text(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string three(3, quote);
  const bool is_long = text.substr(begin, 3) == three;
  const std::string closing = is_long ? three : std::string(1, quote);
  for (std::size_t i = begin + closing.size(); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text.substr(i, closing.size()) == closing) {
      return i + closing.size();
    } else if (text[i] == '\n' && !is_long) {
      return i;  // never closed: the parser says so
    }
  }
  return text.size();
}

// a.b.c nests two tables; walking and freeing nested tables takes stack, and the parser bounds only
// the nesting of values (256).
constexpr int kMostDots = 16;

// The dots that part keys, outside of texts and comments.
void check_dotted_keys(std::string_view text, std::string_view file_name) {
  int dots = 0;
  std::size_t line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '#') i = std::min(text.find('\n', i), text.size()) - 1;
    if (c == '"' || c == '\'') {
      const std::size_t end = end_of_toml_text(text, i);
      line += static_cast<std::size_t>(std::ranges::count(text.substr(i, end - i), '\n'));
      i = end - 1;
    }
    if (c == '\n') ++line;
    if (c == '\n' || c == '=' || c == ',' || c == '{' || c == '[') dots = 0;
    if (c == '.' && ++dots > kMostDots) {
      throw_bad_input(fmt::format("a key of more than {} parts", kMostDots),
                      fmt::format("{}:{}", file_name, line), "no key here has more than a few");
    }
  }
}

TomlValue plain_value(const toml::node& node, const std::string& place) {
  if (const auto flag = node.as_boolean()) return flag->get();
  if (const auto integer = node.as_integer()) return integer->get();
  if (const auto number = node.as_floating_point()) return number->get();
  if (const auto text = node.as_string()) return text->get();
  throw_bad_input("the value must be true or false, a number or a text", place);
}

// What a node has to be for a kind of value, and that value; false where it is something else.
std::string_view wanted(const std::string&) { return "a text"; }
bool take(const toml::node& node, std::string& value) {
  const auto* text = node.as_string();
  if (text != nullptr) value = text->get();
  return text != nullptr;
}

std::string_view wanted(bool) { return "true or false"; }
bool take(const toml::node& node, bool& value) {
  const auto* flag = node.as_boolean();
  if (flag != nullptr) value = flag->get();
  return flag != nullptr;
}

std::string_view wanted(std::uint64_t) {
  return "a whole number, not negative, up to 9223372036854775807";
}
bool take(const toml::node& node, std::uint64_t& value) {
  if (node.is_integer()) {
    if (node.as_integer()->get() < 0) return false;
    value = static_cast<std::uint64_t>(node.as_integer()->get());
    return true;
  }
  // 1e8 is a whole number too, and how people write budgets.
  const std::optional<double> number = node.value<double>();
  const bool whole = number && *number >= 0 && *number < 9.2e18 &&
                     *number == static_cast<double>(static_cast<std::uint64_t>(*number));
  if (!whole) return false;
  value = static_cast<std::uint64_t>(*number);
  return true;
}

bool take(const toml::node& node, double& value) {
  const std::optional<double> number = node.value<double>();
  if (!number || !std::isfinite(*number)) return false;
  value = *number;
  return true;
}

std::string_view wanted(const std::vector<std::string>&) { return "an array of texts"; }
std::string_view wanted(const std::vector<std::uint64_t>&) {
  return "an array of whole numbers, not negative";
}
std::string_view wanted(const std::vector<double>&) { return "an array of finite numbers"; }
template <typename Value>
bool take(const toml::node& node, std::vector<Value>& values) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return false;
  values.clear();
  return std::ranges::all_of(
      *array, [&](const toml::node& each) { return take(each, values.emplace_back()); });
}

// What messages call a table.
std::string named(const std::string& where) { return where.empty() ? "the file" : where; }

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view file_name) {
  check_dotted_keys(text, file_name);
  try {
    return toml::parse(text, file_name);
  } catch (const toml::parse_error& error) {
    throw_bad_input(error.description(), place_of(std::string(file_name), error.source()));
  }
}

TomlTable::TomlTable(const toml::table& table, std::string file_name, std::string where,
                     const std::vector<std::string>& known_keys)
    : table_(&table), file_name_(std::move(file_name)), where_(std::move(where)) {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::ranges::count(known_keys, name) > 0) continue;
    throw_bad_input(fmt::format("unknown key '{}' in {}", name, named(where_)),
                    place_of(file_name_, key.source()), did_you_mean(name, known_keys));
  }
}

std::string TomlTable::place(std::string_view key) const {
  const toml::node* node = table_->get(key);
  return place_of(file_name_, node != nullptr ? node->source() : table_->source());
}

std::string TomlTable::place() const { return place_of(file_name_, table_->source()); }

void TomlTable::refuse(std::string_view key, std::string_view wanted) const {
  throw_bad_input(fmt::format("'{}' in {} must be {}", key, named(where_), wanted), place(key));
}

template <typename Value>
void TomlTable::read(std::string_view key, Value& value) const {
  if (!has(key)) return;
  if (!take(*table_->get(key), value)) refuse(key, wanted(value));
}
template void TomlTable::read(std::string_view, std::string&) const;
template void TomlTable::read(std::string_view, bool&) const;
template void TomlTable::read(std::string_view, std::uint64_t&) const;
template void TomlTable::read(std::string_view, std::vector<std::string>&) const;
template void TomlTable::read(std::string_view, std::vector<std::uint64_t>&) const;
template void TomlTable::read(std::string_view, std::vector<double>&) const;

template <typename Number>
void TomlTable::read(std::string_view key, Number& value, std::type_identity_t<Number> low,
                     std::type_identity_t<Number> high) const {
  if (!has(key)) return;
  constexpr bool kIsWhole = std::is_same_v<Number, int>;
  const toml::node& node = *table_->get(key);
  const std::optional<double> number =
      kIsWhole && !node.is_integer() ? std::nullopt : node.value<double>();
  if (!number || !(*number >= low && *number <= high)) {
    refuse(key, fmt::format("a {} from {} to {}", kIsWhole ? "whole number" : "number", low, high));
  }
  value = static_cast<Number>(*number);
}
template void TomlTable::read(std::string_view, double&, double, double) const;
template void TomlTable::read(std::string_view, int&, int, int) const;

std::vector<TomlValue> TomlTable::value_array(std::string_view key) const {
  std::vector<TomlValue> values;
  if (!has(key)) return values;
  const toml::array* array = table_->get(key)->as_array();
  if (array == nullptr || array->empty()) refuse(key, "an array of values, as in [1, 2, 3]");
  for (const toml::node& node : *array) {
    values.push_back(plain_value(node, place_of(file_name_, node.source())));
  }
  return values;
}

std::vector<std::string> TomlTable::keys(std::string_view key) const {
  std::vector<std::string> names;
  if (!has(key)) return names;
  const toml::table* inner = table_->get(key)->as_table();
  if (inner == nullptr) refuse(key, "a table");
  for (const auto& [name, node] : *inner) names.emplace_back(name.str());
  return names;
}

void TomlTable::require(std::string_view key) const {
  if (has(key)) return;
  throw_bad_input(fmt::format("'{}' is missing in {}", key, named(where_)), place());
}

std::map<std::string, TomlValue> TomlTable::values(std::string_view key) const {
  std::map<std::string, TomlValue> values;
  if (!has(key)) return values;
  const toml::table* inner = table_->get(key)->as_table();
  if (inner == nullptr) refuse(key, "a table, as in { islands = 8 }");
  for (const auto& [name, node] : *inner) {
    values[std::string(name.str())] = plain_value(node, place_of(file_name_, node.source()));
  }
  return values;
}

TomlTable TomlTable::table(std::string_view key, const std::vector<std::string>& known_keys) const {
  const std::string name =
      where_.empty() ? fmt::format("[{}]", key) : fmt::format("{} of {}", key, where_);
  static const toml::table kEmpty;
  if (!has(key)) return {kEmpty, file_name_, name, known_keys};
  const toml::table* inner = table_->get(key)->as_table();
  if (inner == nullptr) {
    refuse(key,
           fmt::format("a table: {} = {{ {} = ... }}", key, fmt::join(known_keys, " = ..., ")));
  }
  return {*inner, file_name_, name, known_keys};
}

std::vector<TomlTable> TomlTable::array_of_tables(
    std::string_view key, const std::vector<std::string>& known_keys) const {
  std::vector<TomlTable> all;
  if (!has(key)) return all;
  const toml::array* array = table_->get(key)->as_array();
  if (array == nullptr) refuse(key, fmt::format("written as [[{}]]", key));
  for (const toml::node& node : *array) {
    if (node.as_table() == nullptr) refuse(key, fmt::format("written as [[{}]]", key));
    all.emplace_back(*node.as_table(), file_name_, fmt::format("[[{}]]", key), known_keys);
  }
  return all;
}

}  // namespace tribench
