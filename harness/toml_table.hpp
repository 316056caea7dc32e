// SPDX-License-Identifier: MIT
//
// One table of a TOML file, read strictly: a key that is not known is refused with the nearest
// name, a value of another kind with what is wanted, both with file, line and column.
// Private to the harness's readers.
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

class TomlTable {
 public:
  // Does not own the table. `where` is how messages call it ("[grid]"); empty for the whole file.
  // Throws Error (bad_input) for unknown keys.
  TomlTable(const toml::table& table, std::string file_name, std::string where,
            const std::vector<std::string>& known_keys);

  bool has(std::string_view key) const { return table_->contains(key); }
  // Each throws Error (bad_input) for a value of another kind; the reference holds the default.
  void read(std::string_view key, std::string& value) const;
  void read(std::string_view key, bool& value) const;
  void read(std::string_view key, double& value, double low, double high) const;
  void read(std::string_view key, std::uint64_t& value) const;
  void read(std::string_view key, int& value, int low, int high) const;
  void read(std::string_view key, std::vector<std::string>& value) const;
  // Throws where the key is missing.
  void require(std::string_view key) const;
  std::map<std::string, ParameterValue> parameters(std::string_view key) const;
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
