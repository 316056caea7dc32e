// SPDX-License-Identifier: MIT
#include "harness/cli/reference_page.hpp"

#include <fmt/format.h>

namespace tribench {
namespace {

constexpr const char* kHead =
    "<!-- Written by `tribench describe markdown`; do not edit. -->\n\n"
    "# The command line\n\n"
    "Every subcommand with its options; the same as `--help`, `man tribench` and the shells' "
    "completion.\n";

// Text in a table's cell: no bar ends it, nothing in it is markup.
std::string markdown_cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') result += '\\';
    result += c;
  }
  return result;
}

// "`--jobs`, `-j` INT", "`DATA`"
std::string option_cell(const CommandOption& option) {
  if (option.names.empty()) return fmt::format("`{}`", option.value_name);
  std::string result;
  for (const std::string& name : option.names) {
    result += fmt::format("{}`{}`", result.empty() ? "" : ", ", name);
  }
  return option.value_name.empty() ? result : result + " " + markdown_cell(value_of(option));
}

// --help stands on every command and is said once, above.
bool is_help(const CommandOption& option) {
  return !option.names.empty() && option.names.front() == "--help";
}

void add_option_table(std::string& page, const Command& command) {
  std::string rows;
  for (const auto* options : {&command.positionals, &command.options}) {
    for (const CommandOption& option : *options) {
      if (is_help(option)) continue;
      rows += fmt::format("| {} | {}{} |\n", option_cell(option), markdown_cell(option.description),
                          option.required ? " (required)" : "");
    }
  }
  if (!rows.empty()) page += "\n| option | what |\n| --- | --- |\n" + rows;
}

}  // namespace

std::string reference_page(const Command& program) {
  std::string page = kHead;
  for (const Command* command : all_commands(program)) {
    page += fmt::format("\n## {}\n\n{}{}\n", command->path, command->description,
                        command->description.ends_with('.') ? "" : ".");
    add_option_table(page, *command);
    for (std::size_t i = 0; i < command->notes.size(); ++i) {
      if (i == 0) page += '\n';
      page += fmt::format("    {}\n", command->notes[i]);
    }
  }
  return page;
}

}  // namespace tribench
