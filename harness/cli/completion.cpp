// SPDX-License-Identifier: MIT
#include "harness/cli/completion.hpp"

#include <fmt/format.h>

#include <map>

#include "foundation/shell_word.hpp"

namespace tribench {
namespace {

std::string words_of(const CommandOption& option) {
  if (!option.choices.empty()) return shell_word(fmt::format("{}", fmt::join(option.choices, " ")));
  if (!option.list.empty()) return fmt::format("$(_tribench_names {})", option.list);
  return "''";  // none of its own: the shell offers files
}

std::string subcommand_names(const Command& command) {
  std::string names;
  for (const Command& child : command.subcommands) names += child.name + " ";
  return names;
}

// Which words are subcommands where: "'tribench study loop') ..."
std::string path_cases(const Command& program) {
  std::string cases;
  for (const Command* command : all_commands(program)) {
    if (command == &program) continue;
    cases += fmt::format("{}{}", cases.empty() ? "" : " | ", shell_word(command->path));
  }
  return cases;
}

// What may follow an option that takes a value; options with the same answer share a line.
std::string value_cases(const Command& program) {
  std::map<std::string, std::string> patterns;
  for (const Command* command : all_commands(program)) {
    for (const CommandOption& option : command->options) {
      if (option.value_name.empty()) continue;
      for (const std::string& name : option.names) {
        std::string& pattern = patterns[words_of(option)];
        if (!pattern.empty()) pattern += " | ";
        pattern += shell_word(command->path + " " + name);
      }
    }
  }
  std::string cases;
  for (const auto& [words, pattern] : patterns) {
    cases += fmt::format("    {}) words={} ;;\n", pattern, words);
  }
  return cases;
}

// What may stand where no value is due: subcommands, options, names for a positional.
std::string word_cases(const Command& program) {
  std::string cases;
  for (const Command* command : all_commands(program)) {
    std::string options;
    for (const CommandOption& option : command->options) {
      options += fmt::format("{} ", fmt::join(option.names, " "));
    }
    std::string names = shell_word(subcommand_names(*command));
    if (!command->positionals.empty()) names = words_of(command->positionals.front());
    cases += fmt::format("    {})\n        options={}\n        words={}\n        ;;\n",
                         shell_word(command->path), shell_word(options), names);
  }
  return cases;
}

// The function that bash and zsh share; {path_cases}, {value_cases}, {word_cases} are the
// command's.
// (Not `path`, which zsh ties to PATH.)
constexpr const char* kBashFunction = R"(_tribench_names() {{
    command tribench list "$1" 2>/dev/null | while read -r name rest; do echo "$name"; done
}}

_tribench_complete() {{
    local current previous typed=tribench words='' options='' i
    current=${{COMP_WORDS[COMP_CWORD]}}
    previous=${{COMP_WORDS[COMP_CWORD - 1]}}
    for ((i = 1; i < COMP_CWORD; i++)); do
        case "$typed ${{COMP_WORDS[i]}}" in
        {path_cases}) typed="$typed ${{COMP_WORDS[i]}}" ;;
        esac
    done
    COMPREPLY=()
    case "$typed $previous" in
{value_cases}    *)
        case $typed in
{word_cases}        esac
        case $current in -*) words=$options ;; esac
        ;;
    esac
    COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
)";

std::string bash_function(const Command& program) {
  return fmt::format(kBashFunction, fmt::arg("path_cases", path_cases(program)),
                     fmt::arg("value_cases", value_cases(program)),
                     fmt::arg("word_cases", word_cases(program)));
}

// "__tribench_at study loop": fish asks whether these subcommands have been typed, and no more.
std::string fish_condition(const Command& command) {
  const std::size_t space = command.path.find(' ');
  const std::string words = space == std::string::npos ? "" : command.path.substr(space);
  return fmt::format("__tribench_at{}", words);
}

std::string fish_values(const CommandOption& option) {
  if (!option.choices.empty()) {
    return fmt::format(" -xa {}", shell_word(fmt::format("{}", fmt::join(option.choices, " "))));
  }
  if (!option.list.empty()) return fmt::format(" -xa '(__tribench_names {})'", option.list);
  return option.value_name.empty() ? "" : " -rF";
}

void add_fish_lines(std::string& script, const Command& command) {
  const std::string start =
      fmt::format("complete -c tribench -n {}", shell_word(fish_condition(command)));
  for (const Command& child : command.subcommands) {
    script += fmt::format("{} -f -a {} -d {}\n", start, child.name, shell_word(child.description));
  }
  for (const CommandOption& option : command.options) {
    script += start;
    for (const std::string& name : option.names) {
      script += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    script += fmt::format("{} -d {}\n", fish_values(option), shell_word(option.description));
  }
  for (const CommandOption& positional : command.positionals) {
    if (positional.list.empty()) continue;
    script += fmt::format("{} -a '(__tribench_names {})'\n", start, positional.list);
  }
}

// Which subcommands stand in the line so far, against those that a line of completion is for.
std::string fish_functions(const Command& program) {
  std::string paths;
  for (const Command* command : all_commands(program)) {
    if (command != &program) paths += shell_word(command->path) + " ";
  }
  return fmt::format(
      "function __tribench_names\n"
      "    command tribench list $argv[1] 2>/dev/null | string replace -r ' .*' ''\n"
      "end\n\n"
      "function __tribench_at\n"
      "    set -l path tribench\n"
      "    for word in (commandline -opc)[2..-1]\n"
      "        contains -- \"$path $word\" {}; and set path \"$path $word\"\n"
      "    end\n"
      "    test \"$path\" = (string join ' ' tribench $argv)\n"
      "end\n\n",
      paths);
}

}  // namespace

std::string bash_completion(const Command& program) {
  return "# Completion of tribench for bash; printed by the program itself.\n" +
         bash_function(program) + "\ncomplete -o default -F _tribench_complete tribench\n";
}

std::string zsh_completion(const Command& program) {
  return "#compdef tribench\n"
         "# Completion of tribench for zsh; printed by the program itself.\n"
         "autoload -Uz bashcompinit\nbashcompinit\n" +
         bash_function(program) +
         "\ncomplete -o default -F _tribench_complete tribench\n"
         "_bash_complete -o default -F _tribench_complete\n";
}

std::string fish_completion(const Command& program) {
  std::string script = "# Completion of tribench for fish; printed by the program itself.\n" +
                       fish_functions(program);
  for (const Command* command : all_commands(program)) add_fish_lines(script, *command);
  return script;
}

}  // namespace tribench
