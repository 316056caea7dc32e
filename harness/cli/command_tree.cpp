// SPDX-License-Identifier: MIT
#include "harness/cli/command_tree.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <utility>

#include "foundation/text.hpp"

namespace tribench {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// CLI11 writes an option's type and checks as "TEXT:{c,python}" or "INT:INT in [1 - 9]".
void read_type(const std::string& type, CommandOption& option) {
  const std::size_t colon = type.find(':');
  option.value_name = type.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string check = type.substr(colon + 1);
  if (check.starts_with('{') && check.ends_with('}')) {
    option.choices = split(check.substr(1, check.size() - 2), ',');
    return;
  }
  const std::size_t range = check.find('[');
  if (range != std::string::npos) option.description += " " + check.substr(range);
}

// The convention of the descriptions: "a name of `tribench list methods`".
std::string list_named_in(const std::string& description) {
  static const std::string kPhrase = "`tribench list ";
  const std::size_t begin = description.find(kPhrase);
  if (begin == std::string::npos) return {};
  const std::size_t word = begin + kPhrase.size();
  return description.substr(word, description.find('`', word) - word);
}

CommandOption described(const CLI::Option& option) {
  CommandOption result;
  for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
  result.description = option.get_description();
  result.required = option.get_required();
  result.list = list_named_in(result.description);
  if (option.get_items_expected_max() > 0) read_type(option.get_type_name(), result);
  if (!option.nonpositional()) result.value_name = option.get_name(true);
  if (!option.get_default_str().empty()) {
    result.description += " [default: " + option.get_default_str() + "]";
  }
  return result;
}

Command described(const CLI::App& app, const std::string& parent) {
  Command command;
  command.name = app.get_name();
  command.path = parent.empty() ? command.name : parent + " " + command.name;
  command.description = app.get_description();
  command.notes = lines_of(app.get_footer());
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    auto& kind = option->nonpositional() ? command.options : command.positionals;
    kind.push_back(described(*option));
  }
  for (const CLI::App* child : app.get_subcommands(nullptr)) {
    if (!child->get_group().empty()) command.subcommands.push_back(described(*child, command.path));
  }
  return command;
}

void collect(const Command& command, std::vector<const Command*>& all) {
  all.push_back(&command);
  for (const Command& child : command.subcommands) collect(child, all);
}

}  // namespace

std::string value_of(const CommandOption& option) {
  if (option.choices.empty()) return option.value_name;
  return fmt::format("{}", fmt::join(option.choices, "|"));
}

Command command_tree(const CLI::App& app) { return described(app, ""); }

std::vector<const Command*> all_commands(const Command& root) {
  std::vector<const Command*> all;
  collect(root, all);
  return all;
}

}  // namespace tribench
