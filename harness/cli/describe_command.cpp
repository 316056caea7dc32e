// SPDX-License-Identifier: MIT
//
// tribench describe: the command line in other forms, for the install and the docs (hidden from
// --help).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <memory>

#include "harness/build_info.hpp"
#include "harness/cli/command_tree.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/completion.hpp"
#include "harness/cli/man_page.hpp"
#include "harness/cli/reference_page.hpp"

namespace tribench {
namespace {

using Form = std::function<std::string(const Command&)>;

const std::map<std::string, Form>& forms() {
  static const std::map<std::string, Form> kForms = {
      {"man", [](const Command& program) { return man_page(program, build_info().version); }},
      {"bash", bash_completion},
      {"zsh", zsh_completion},
      {"fish", fish_completion},
      {"markdown", reference_page},
  };
  return kForms;
}

}  // namespace

void add_describe_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "describe", "The command line as a man page, a page of the docs or completion");
  command->group("");
  auto form = std::make_shared<std::string>();
  command->add_option("form", *form, "man, markdown, or the shell to complete in")
      ->required()
      ->check(CLI::IsMember(forms()));
  command->callback([&app, form] { fmt::print("{}", forms().at(*form)(command_tree(app))); });
}

}  // namespace tribench
