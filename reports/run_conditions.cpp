// SPDX-License-Identifier: MIT
#include "reports/run_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>

#include "foundation/text.hpp"

namespace tribench {
namespace {

constexpr std::size_t kShown = 60;  // characters of a value

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Opening less closing brackets outside of texts.
int open_brackets(std::string_view text) {
  int open = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++open;
    } else if (c == ']' || c == '}') {
      --open;
    }
  }
  return open;
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && (text.front() == '\'' || text.front() == '"');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// "[budget]", "[[method]]": a table, or one of an array, which is then known by its name.
struct Section {
  std::string name;
  bool is_item = false;
  std::map<std::string, std::string> values;
};

std::vector<Section> read_sections(std::istream& in) {
  std::vector<Section> sections;
  for (std::string line; std::getline(in, line);) {
    std::string text(without_blanks(line));
    if (text.empty() || text.front() == '#') continue;
    if (text.front() == '[') {
      const bool is_item = text.starts_with("[[");
      const std::size_t skip = is_item ? 2 : 1;
      sections.push_back({text.substr(skip, text.size() - 2 * skip), is_item, {}});
      continue;
    }
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || sections.empty()) continue;
    for (std::string more; open_brackets(text) > 0 && std::getline(in, more);) {
      text += fmt::format(" {}", without_blanks(more));
    }
    sections.back().values[std::string(without_blanks(text.substr(0, equals)))] =
        without_blanks(std::string_view(text).substr(equals + 1));
  }
  return sections;
}

std::string shortened_value(const std::string& value) {
  return value.size() <= kShown ? value : value.substr(0, kShown) + "...";
}

}  // namespace

std::map<std::string, std::string> read_settings(const std::filesystem::path& grid_toml) {
  std::ifstream in = open_file_if_there(grid_toml);
  std::map<std::string, std::string> settings;
  std::string item;  // "method" and "method pysr" while its own tables follow
  std::string item_key;
  for (const Section& section : read_sections(in)) {
    std::string prefix = section.name;
    if (section.is_item) {
      const auto name = section.values.find("name");
      item = section.name;
      item_key =
          fmt::format("{} {}", item, name == section.values.end() ? "?" : unquoted(name->second));
      prefix = item_key;
    } else if (!item.empty() && section.name.starts_with(item + ".")) {
      prefix = item_key + section.name.substr(item.size());
    }
    for (const auto& [key, value] : section.values) settings[prefix + "." + key] = value;
  }
  settings.erase("grid.name");
  return settings;
}

std::vector<std::string> condition_differences(const RunFolder& base, const RunFolder& now) {
  const auto before = read_settings(base.path / "grid.toml");
  const auto after = read_settings(now.path / "grid.toml");
  std::set<std::string> keys;
  for (const auto& [key, value] : before) keys.insert(key);
  for (const auto& [key, value] : after) keys.insert(key);
  const auto value_in = [](const std::map<std::string, std::string>& settings,
                           const std::string& key) {
    const auto found = settings.find(key);
    return found == settings.end() ? std::string("none") : found->second;
  };
  std::vector<std::string> lines;
  if (before.empty() != after.empty()) {
    lines.emplace_back("only one of the two runs has a grid.toml");
    return lines;
  }
  for (const std::string& key : keys) {
    const std::string old_value = value_in(before, key);
    const std::string new_value = value_in(after, key);
    if (old_value == new_value) continue;
    lines.push_back(
        fmt::format("{}: {} -> {}", key, shortened_value(old_value), shortened_value(new_value)));
  }
  const std::string data = base.provenance_of("data_hash");
  if (data != now.provenance_of("data_hash")) lines.emplace_back("the data differ");
  return lines;
}

}  // namespace tribench
