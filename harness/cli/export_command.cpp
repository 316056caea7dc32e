// SPDX-License-Identifier: MIT
//
// tribench export: a formula as code for a controller, a notebook or a paper.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/expression/export.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/states/state_export.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "foundation/suggestion.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/loop_formula.hpp"
#include "harness/cli/number_options.hpp"
#include "harness/loop/controller_code.hpp"
#include "harness/motion/simulator_friction.hpp"
#include "problems/preparation/derived_channels.hpp"

namespace tribench {
namespace {

struct ExportArguments {
  std::string formula;
  std::string form;
  std::string box;
  std::string derive;
  std::string out;
  bool single = false;
  ExportOptions options;
  std::string joint = "joint";
  std::string velocity = "v";
  std::string acceleration = "a";
  std::optional<double> inertia;
  bool is_linear = false;
};

// Of code; an unknown name is answered with the nearest of code and simulators.
CodeForm find_form(const std::string& name) {
  std::vector<std::string> names = code_form_names();
  if (std::ranges::count(names, name) > 0) return find_code_form(name);
  names.insert(names.end(), simulator_names().begin(), simulator_names().end());
  throw_bad_input(fmt::format("there is no form '{}'", name), "--as", did_you_mean(name, names));
}

// "d=q", "d=v"
std::optional<loop::PathFrom> distance_from(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (text == "d=q") return loop::PathFrom::position;
  if (text == "d=v") return loop::PathFrom::velocity;
  throw_bad_input(
      fmt::format("'{}' derives no channel that is known", text), "--derive",
      "write d=q (distance since reversal from the position) or d=v (from the velocity)");
}

void write_code(const ExportArguments& arguments, const std::string& code) {
  if (arguments.out.empty()) {
    fmt::print("{}", code);
  } else {
    write_file(arguments.out, code);
  }
}

std::string stateful_code(const ExportArguments& arguments, CodeForm form) {
  if (!arguments.derive.empty()) {
    throw_bad_input("a formula with states keeps its own history", "--derive", "leave it out");
  }
  StatefulExportOptions options{arguments.options.function, {}, arguments.single};
  std::vector<std::string> names;
  if (arguments.options.box) {
    options.box = arguments.options.box;
    names = options.box->names;
    NamedBox whole = *options.box;
    parse_stateful_over(arguments.formula, whole);  // refuses a name that has no range
  }
  const StatefulFormula formula = parse_stateful_collecting(arguments.formula, names);
  return export_stateful(formula, names, form, options);
}

// The parameters that a simulator's joint can take of it.
void write_simulator(const ExportArguments& arguments, Simulator simulator) {
  if (!arguments.options.box) {
    throw_bad_input("a simulator's parameters are fitted over a box", "--box",
                    "give it: --box 'v=-2:2,g=-60:60'");
  }
  const SimulatorFriction friction =
      fit_simulator_friction(arguments.formula, *arguments.options.box, arguments.velocity,
                             arguments.acceleration, simulator, arguments.inertia);
  write_code(arguments, simulator_text(friction, simulator, arguments.formula, arguments.joint,
                                       arguments.is_linear));
}

// A current is no torque to a simulator.
void refuse_other_units(const LoopFormula& loop, const std::string& file) {
  if (loop.unit.empty() || loop.unit == "N m" || loop.unit == "N") return;
  throw_bad_input(fmt::format("this friction is in {}, and a simulator takes N m or N", loop.unit),
                  file, "give 'tribench loop' the --torque-constant");
}

// A loop.json tells its formula, its box and how its distance is derived, unless options do.
void read_loop(ExportArguments& arguments, std::optional<loop::PathFrom>& from) {
  if (!arguments.formula.ends_with(".json")) return;
  const std::optional<NamedBox>& given = arguments.options.box;
  LoopFormula loop =
      read_loop_formula(arguments.formula, given ? given->names : std::vector<std::string>{});
  if (find_simulator(arguments.form)) refuse_other_units(loop, arguments.formula);
  arguments.formula = std::move(loop.text);
  if (!given) arguments.options.box = std::move(loop.box);
  if (!from) from = loop.distance_from;
}

void write_export(ExportArguments arguments) {
  if (!arguments.box.empty()) arguments.options.box = parse_box(arguments.box);
  std::optional<loop::PathFrom> from = distance_from(arguments.derive);
  read_loop(arguments, from);
  if (const std::optional<Simulator> simulator = find_simulator(arguments.form)) {
    write_simulator(arguments, *simulator);
    return;
  }
  const CodeForm form = find_form(arguments.form);
  if (declares_states(arguments.formula)) {
    write_code(arguments, stateful_code(arguments, form));
    return;
  }
  if (arguments.single) {
    throw_bad_input("only a formula with states is written in single precision", "--single",
                    "leave it out");
  }
  ExportOptions options = arguments.options;
  std::vector<std::string> names;
  Expression formula;
  if (!options.box) {
    formula = parse_collecting_names(arguments.formula, names);
  } else {
    formula = parse_over(arguments.formula, *options.box);
    names = options.box->names;
  }
  const std::vector<std::string> called = export_arguments(formula, names, options);
  const bool has_history =
      from && form == CodeForm::c && std::ranges::any_of(called, loop::is_distance);
  if (!has_history && !arguments.derive.empty()) {
    throw_bad_input(form == CodeForm::c ? "the formula has no input d" : "only C has a history",
                    "--derive", "leave it out");
  }
  const std::string code = has_history ? loop::controller_code(formula, names, options, from)
                                       : export_code(formula, names, form, options);
  write_code(arguments, code);
}

}  // namespace

void add_export_command(CLI::App& app, ExitStatus& /*status*/) {
  CLI::App* command = app.add_subcommand(
      "export",
      "Code for a controller (C), a notebook, MATLAB, a paper; parameters for a simulator");
  command->footer(
      "Example: tribench export '8.5*sgn_v + 14*v' --as c --box 'v=-2:2' --function friction\n"
      "An input sgn_X is computed from X. In front of a formula that begins with a minus put --.\n"
      "With states ('z = dahl(v, sliding=1e-5); 2e6*z') the code has init and step.\n"
      "A simulator takes Coulomb and viscous friction alone: what that loses is said beside them.\n"
      "In place of a formula: the loop.json of 'tribench loop', with its box, and its channels' "
      "history\nin C. Gravity that it fitted is put in where the friction reads it, and not "
      "added.");
  auto arguments = std::make_shared<ExportArguments>();
  command->add_option("formula", arguments->formula, "the formula, or a loop.json")->required();
  command
      ->add_option("--as", arguments->form, "c, python, latex, sympy, matlab; mujoco, urdf, isaac")
      ->required();
  command->add_option(
      "--box", arguments->box,
      "where the formula was judged: 'v=-2:2,g=-60:60'; fixes the arguments' order");
  command->add_option("--derive", arguments->derive,
                      "d=q or d=v: C that keeps the distance since the last reversal up to date");
  command->add_option("--function", arguments->options.function, "the function's name")
      ->capture_default_str();
  command
      ->add_option("--digits", arguments->options.digits,
                   "significant digits of constants in LaTeX; 0: all")
      ->transform(whole_number(0, 17));
  command->add_flag("--single", arguments->single,
                    "C of a formula with states in single precision");
  command->add_option("--joint", arguments->joint, "a simulator's joint (class)")
      ->capture_default_str();
  command
      ->add_option("--velocity", arguments->velocity, "the box's name for a simulator's velocity")
      ->capture_default_str();
  command
      ->add_option("--acceleration", arguments->acceleration,
                   "the box's name for the acceleration, of which an armature is made")
      ->capture_default_str();
  command
      ->add_option("--inertia", arguments->inertia,
                   "of the joint: says what a simulator's parameters cost in motion too")
      ->transform(real_number(0, 1e9, LowEnd::above));
  command->add_flag("--linear", arguments->is_linear, "a slide: N and m, for N m and rad");
  command->add_option("--out", arguments->out, "a file instead of the screen");
  command->callback([arguments] { write_export(*arguments); });
}

}  // namespace tribench
