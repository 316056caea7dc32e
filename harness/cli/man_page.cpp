// SPDX-License-Identifier: MIT
#include "harness/cli/man_page.hpp"

#include <fmt/format.h>

namespace tribench {
namespace {

// Text as roff takes it: no escapes, no hyphens for minus signs, no line that begins as a request.
std::string roff(std::string_view text) {
  std::string result;
  if (text.starts_with('.') || text.starts_with('\'')) result += "\\&";
  for (const char c : text) {
    switch (c) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        result += c;
    }
  }
  return result;
}

// "-h, --help", "--jobs INT", "DATA"
std::string term(const CommandOption& option) {
  std::string result;
  for (const std::string& name : option.names) {
    result += fmt::format("{}\\fB{}\\fR", result.empty() ? "" : ", ", roff(name));
  }
  if (option.value_name.empty()) return result;
  return result + fmt::format("{}\\fI{}\\fR", result.empty() ? "" : " ", roff(value_of(option)));
}

void add_options(std::string& page, const std::vector<CommandOption>& options) {
  for (const CommandOption& option : options) {
    page += fmt::format(".TP\n{}\n{}{}\n", term(option), roff(option.description),
                        option.required ? " (required)" : "");
  }
}

std::string synopsis(const Command& command) {
  std::string line = fmt::format("\\fB{}\\fR", roff(command.path));
  if (!command.options.empty()) line += " [\\fIOPTIONS\\fR]";
  for (const CommandOption& positional : command.positionals) {
    const std::string name = fmt::format("\\fI{}\\fR", roff(positional.value_name));
    line += positional.required ? " " + name : " [" + name + "]";
  }
  if (!command.subcommands.empty()) line += " \\fISUBCOMMAND\\fR";
  return line;
}

void add_notes(std::string& page, const Command& command) {
  for (std::size_t i = 0; i < command.notes.size(); ++i) {
    page += fmt::format("{}\n{}\n", i == 0 ? ".PP" : ".br", roff(command.notes[i]));
  }
}

}  // namespace

std::string man_page(const Command& program, std::string_view version) {
  std::string page = fmt::format(
      ".TH TRIBENCH 1 \"\" \"tribench {}\" \"User Commands\"\n.SH NAME\ntribench \\- {}\n"
      ".SH SYNOPSIS\n{}\n.SH DESCRIPTION\n{}\n",
      roff(version), roff("symbolic regression of joint friction, benchmarked"), synopsis(program),
      roff(program.description));
  add_notes(page, program);
  add_options(page, program.options);
  page += ".SH SUBCOMMANDS\n";
  for (const Command* command : all_commands(program)) {
    if (command == &program) continue;
    page += fmt::format(".SS {}\n{}\n.PP\n{}\n", roff(command->path), synopsis(*command),
                        roff(command->description));
    add_options(page, command->positionals);
    add_options(page, command->options);
    add_notes(page, *command);
  }
  return page;
}

}  // namespace tribench
