// SPDX-License-Identifier: MIT
//
// The command line as data: what --help prints, for those who print it in other forms (the man
// page, the shells' completion). Hidden subcommands and options are left out. For reading alone:
// parsing stays CLI11's.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace tribench {

struct CommandOption {
  std::vector<std::string> names;    // "--out", "-h"; empty for a positional
  std::string value_name;            // what stands for its value: "DATA", "FLOAT"; empty for a flag
  std::string description;           // with its range and default, as --help has them
  std::vector<std::string> choices;  // the only values there are, where there is such a list
  std::string list;                  // "methods": its values are those of `tribench list methods`
  bool required = false;
};

struct Command {
  std::string path;  // "tribench study loop"
  std::string name;  // "loop"
  std::string description;
  std::vector<std::string> notes;  // what --help ends with, line by line
  std::vector<CommandOption> options;
  std::vector<CommandOption> positionals;
  std::vector<Command> subcommands;
};

Command command_tree(const CLI::App& app);

// What stands for an option's value: its choices ("c|python"), or its value's name.
std::string value_of(const CommandOption& option);

// A command and all below it, from the top down.
std::vector<const Command*> all_commands(const Command& root);

}  // namespace tribench
