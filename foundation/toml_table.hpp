// SPDX-License-Identifier: MIT
//
// One table of a TOML file, read strictly: a key that is not known is refused with the nearest
// name, a value of another kind with what is wanted, both with file, line and column.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace tribench {

// A value that stands for itself: no table, array or date.
using TomlValue = std::variant<bool, std::int64_t, double, std::string>;

// Throws Error (bad_input) with file, line and column where it is no TOML. The table's places name
// `file_name`.
toml::table parse_toml(std::string_view text, std::string_view file_name);

class TomlTable {
 public:
  // Does not own the table. `where` is how messages call it ("[grid]"); empty for the whole file.
  // Throws Error (bad_input) for unknown keys.
  TomlTable(const toml::table& table, std::string file_name, std::string where,
            const std::vector<std::string>& known_keys);

  bool has(std::string_view key) const { return table_->contains(key); }
  bool has_text(std::string_view key) const { return (*table_)[key].is_string(); }
  // Each throws Error (bad_input) for a value of another kind; the reference holds the default.
  // A text, true or false, a whole number that is not negative (1e8 is one too), or an array of
  // texts, of such whole numbers or of finite numbers.
  template <typename Value>
  void read(std::string_view key, Value& value) const;
  // A double or an int within [low, high].
  template <typename Number>
  void read(std::string_view key, Number& value, std::type_identity_t<Number> low,
            std::type_identity_t<Number> high) const;
  // Throws where the key is missing.
  void require(std::string_view key) const;
  // Every key with its value, of an inner table that may have any keys.
  std::map<std::string, TomlValue> values(std::string_view key) const;
  // An array of values that stand for themselves; none where the key is missing.
  std::vector<TomlValue> value_array(std::string_view key) const;
  // The keys of an inner table that may have any; none where the key is missing.
  std::vector<std::string> keys(std::string_view key) const;
  // An inner table, with its own keys; empty where the key is missing.
  TomlTable table(std::string_view key, const std::vector<std::string>& known_keys) const;
  std::vector<TomlTable> array_of_tables(std::string_view key,
                                         const std::vector<std::string>& known_keys) const;

  std::string place(std::string_view key) const;  // "grid.toml:3:1" of a key
  std::string place() const;                      // of the table

 private:
  [[noreturn]] void refuse(std::string_view key, std::string_view wanted) const;

  const toml::table* table_;  // the parsed file outlives this
  std::string file_name_;
  std::string where_;
};

}  // namespace tribench
