// SPDX-License-Identifier: MIT
//
// tribench export: a formula as code for a controller, a notebook or a paper.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/expression/export.hpp"
#include "algorithms/expression/text.hpp"
#include "harness/cli/commands.hpp"
#include "reports/record_csv.hpp"

namespace tribench {
namespace {

struct ExportArguments {
  std::string formula;
  std::string form;
  std::string box;
  std::string out;
  ExportOptions options;
};

void write_export(const ExportArguments& arguments) {
  const CodeForm form = find_code_form(arguments.form);
  ExportOptions options = arguments.options;
  std::vector<std::string> names;
  Expression formula;
  if (arguments.box.empty()) {
    formula = parse_collecting_names(arguments.formula, names);
  } else {
    options.box = parse_box(arguments.box);
    formula = parse_over(arguments.formula, *options.box);
    names = options.box->names;
  }
  const std::string code = export_code(formula, names, form, options);
  if (arguments.out.empty()) {
    fmt::print("{}", code);
  } else {
    write_file(arguments.out, code);
  }
}

}  // namespace

void add_export_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command =
      app.add_subcommand("export", "Code for a controller (C), a notebook, MATLAB or a paper");
  command->footer(
      "Example: tribench export '8.5*sgn_v + 14*v' --as c --box 'v=-2:2' --function friction\n"
      "An input sgn_X is computed from X. In front of a formula that begins with a minus put --.");
  auto arguments = std::make_shared<ExportArguments>();
  command->add_option("formula", arguments->formula, "the formula")->required();
  command->add_option("--as", arguments->form, "c, python, latex, sympy or matlab")->required();
  command->add_option(
      "--box", arguments->box,
      "where the formula was judged: 'v=-2:2,g=-60:60'; fixes the arguments' order");
  command->add_option("--function", arguments->options.function, "the function's name")
      ->capture_default_str();
  command
      ->add_option("--digits", arguments->options.digits,
                   "significant digits of constants in LaTeX; 0: all")
      ->check(CLI::Range(0, 17));
  command->add_option("--out", arguments->out, "a file instead of the screen");
  command->callback([arguments] { write_export(*arguments); });
}

}  // namespace tribench
