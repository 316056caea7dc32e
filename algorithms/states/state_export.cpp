// SPDX-License-Identifier: MIT
#include "algorithms/states/state_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/export_forms.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/states/state_code.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

// What the code of all languages is made of.
class StepCode {
 public:
  StepCode(const StatefulFormula& formula, std::span<const std::string> names,
           const StatefulExportOptions& options)
      : formula_(formula), options_(options) {
    all_names_.assign(names.begin(),
                      names.begin() + static_cast<std::ptrdiff_t>(formula.first_state));
    for (const StateDeclaration& state : formula.states) all_names_.push_back(state.name);
    ExportOptions plain;
    plain.function = options.function;
    plain.box = options.box;
    inputs_ = code_inputs(formula.formula, all_names_, plain);
    with_drives_ = code_inputs(all_read(), all_names_, plain);
    for (const StateDeclaration& state : formula.states) {
      for (const std::size_t drive : state.drives) {
        if (std::ranges::find(drives_, drive) == drives_.end()) drives_.push_back(drive);
      }
    }
    taken_.insert(options.function);
    for (const CodeInputs::Argument& argument : with_drives_.arguments) {
      taken_.insert(argument.code_name);
    }
    memory_ = free_name("memory");
    seconds_ = free_name("dt");
  }

  CodeSource source() const {
    return {formula_.formula, print_stateful(formula_, all_names_), options_.function, inputs_, 0};
  }

  // The inputs that are arguments: all but the states.
  std::vector<std::string> arguments() const {
    std::vector<std::string> arguments;
    for (const CodeInputs::Argument& argument : with_drives_.arguments) {
      if (!is_state(argument.name)) arguments.push_back(argument.code_name);
    }
    return arguments;
  }

  const std::string& drive_name(std::size_t drive) const {
    return with_drives_.arguments[with_drives_.columns[drive].argument].code_name;
  }
  std::size_t drive_place(std::size_t drive) const {
    return static_cast<std::size_t>(std::ranges::find(drives_, drive) - drives_.begin());
  }
  std::string state_name(std::size_t k) const {
    const CodeInputs::Column& column = with_drives_.columns[formula_.first_state + k];
    return with_drives_.arguments[column.argument].code_name;
  }

  std::set<StateLaw> laws() const {
    std::set<StateLaw> laws;
    for (const StateDeclaration& state : formula_.states) laws.insert(state.law);
    return laws;
  }

  // lugre(z, v0, v1, dt, p...), written by a language's way to say memory and numbers.
  template <typename Write>
  std::string call(std::size_t k, const Write& write) const {
    const StateDeclaration& state = formula_.states[k];
    std::string text =
        fmt::format("{}{}({}", write.prefix, state_law_info(state.law).name, write.memory("z", k));
    if (state.law == StateLaw::gms) text += write.slips(k);
    for (const std::size_t drive : state.drives) {
      text += fmt::format(", {}, {}", write.memory("drive", drive_place(drive)), drive_name(drive));
    }
    if (state.law == StateLaw::warmth && state.drives.size() == 1) {
      text += fmt::format(", {0}, {0}", write.number(1));
    }
    text += ", " + seconds_;
    for (const double p : state.parameters) text += ", " + write.number(p);
    return text + ")";
  }

  const StatefulFormula& formula() const { return formula_; }
  const std::vector<std::size_t>& drives() const { return drives_; }
  const std::string& memory() const { return memory_; }
  const std::string& seconds() const { return seconds_; }
  const StatefulExportOptions& options() const { return options_; }

 private:
  // The formula with every drive in it, so that each has a place among the arguments.
  Expression all_read() const {
    using namespace build;
    Expression sum = formula_.formula;
    for (std::size_t k = 0; k < formula_.states.size(); ++k) {
      for (const std::size_t drive : formula_.states[k].drives) sum = sum + input(drive);
      sum = sum + input(formula_.first_state + k);
    }
    return sum;
  }

  bool is_state(const std::string& name) const {
    return std::ranges::find(formula_.states, name, &StateDeclaration::name) !=
           formula_.states.end();
  }

  std::string free_name(std::string name) const {
    while (taken_.contains(name)) name += '_';
    return name;
  }

  const StatefulFormula& formula_;
  const StatefulExportOptions& options_;
  std::vector<std::string> all_names_;
  CodeInputs inputs_;
  CodeInputs with_drives_;
  std::vector<std::size_t> drives_;
  std::set<std::string> taken_;
  std::string memory_;
  std::string seconds_;
};

std::string in_box_lines(const StepCode& code, std::string_view mark) {
  return ranges_comment(code.source(), mark);
}

// C.

struct CWriter {
  std::string prefix;
  std::string at;  // "memory->"
  std::string real;

  std::string memory(std::string_view field, std::size_t place) const {
    return fmt::format("{}{}[{}]", at, field, place);
  }
  std::string slips(std::size_t k) const { return fmt::format(", &{}slips[{}]", at, k); }
  std::string number(double value) const {
    return fmt::format("({})({})", real, float_literal(value));
  }
};

Dialect c_step_dialect(const CWriter& write, bool single) {
  Dialect c = c_dialect();
  const std::string end = single ? "f" : "";
  c.literal = [write](double value) { return write.number(value); };
  c.unary = [write, end](Op op, std::string_view a) {
    if (op == Op::neg) return fmt::format("-{}", a);
    if (op == Op::exp) return fmt::format("{}exp({})", write.prefix, a);
    if (op == Op::sgn) return fmt::format("{}sign({})", write.prefix, a);
    return fmt::format("{}{}({})", op == Op::abs ? "fabs" : op_name(op), end, a);
  };
  c.binary = [plain = c.binary, end](Op op, std::string_view a, std::string_view b) {
    return op == Op::pow ? fmt::format("pow{}({}, {})", end, a, b) : plain(op, a, b);
  };
  c.declare = fmt::format("const {} ", write.real);
  return c;
}

std::string c_step(const StepCode& code) {
  const std::string& name = code.options().function;
  const CWriter write{name + "_", code.memory() + "->", code.options().single ? "float" : "double"};
  const Dialect dialect = c_step_dialect(write, code.options().single);
  const CodeSource source = code.source();
  const Statements body = write_statements(source, dialect);
  std::string arguments;
  std::string unused;
  for (const std::string& argument : code.arguments()) {
    arguments += fmt::format("{} {}, ", write.real, argument);
    unused += fmt::format("  (void){};\n", argument);
  }
  std::string text = fmt::format(
      "/* {}\n *\n{} *\n"
      " * Call {}_init once, then {}_step at every sample with the seconds since the last one; "
      "the\n"
      " * first starts from rest. Fixed memory, no allocation, no loop over time. Written by\n"
      " * tribench. Compile with -ffp-contract=off, for your processor (its fma), and without\n"
      " * -ffast-math, to get the bits that were judged. */\n",
      source.text, in_box_lines(code, " *"), name, name);
  text += state_code_c(name, code.options().single, code.laws());
  text += fmt::format(
      "typedef struct {{\n  {0} z[{1}];\n  {0} drive[{2}];\n  int slips[{1}];\n  int started;\n"
      "}} {3}_state;\n\nvoid {3}_init({3}_state *{4}) {{\n  int k;\n"
      "  for (k = 0; k < {1}; ++k) {{\n    {4}->z[k] = 0;\n    {4}->slips[k] = 0;\n  }}\n"
      "  for (k = 0; k < {2}; ++k) {4}->drive[k] = 0;\n  {4}->started = 0;\n}}\n\n",
      write.real, code.formula().states.size(), code.drives().size(), name, code.memory());
  text += fmt::format("{0} {1}_step({1}_state *{2}, {3}{0} {4}) {{\n{5}", write.real, name,
                      code.memory(), arguments, code.seconds(), unused);
  text += fmt::format("  if ({}->started) {{\n", code.memory());
  std::string rest;
  for (std::size_t k = 0; k < code.formula().states.size(); ++k) {
    text += fmt::format("    {} = {};\n", write.memory("z", k), code.call(k, write));
    if (code.formula().states[k].law == StateLaw::lag) {
      rest += fmt::format("    {} = {};\n", write.memory("z", k),
                          code.drive_name(code.formula().states[k].drives[0]));
    }
  }
  text += fmt::format("  }} else {{\n{}    {}->started = 1;\n  }}\n", rest, code.memory());
  for (const std::size_t drive : code.drives()) {
    text += fmt::format("  {} = {};\n", write.memory("drive", code.drive_place(drive)),
                        code.drive_name(drive));
  }
  text += "  {\n";
  for (std::size_t k = 0; k < code.formula().states.size(); ++k) {
    text += fmt::format("  const {} {} = {};\n  (void){};\n", write.real, code.state_name(k),
                        write.memory("z", k), code.state_name(k));
  }
  text += sign_lines(source, dialect) + body.text;
  return text + fmt::format("  return {};\n  }}\n}}\n", body.result);
}

// Python, without NumPy: numbers, not arrays.

struct PythonWriter {
  std::string prefix;
  std::string memory(std::string_view field, std::size_t place) const {
    return fmt::format("self.{}[{}]", field, place);
  }
  std::string slips(std::size_t k) const { return fmt::format(", self.slips, {}", k); }
  std::string number(double value) const { return float_literal(value); }
};

std::string python_step(const StepCode& code) {
  const std::string& name = code.options().function;
  const PythonWriter write{"_"};
  Dialect dialect = python_dialect();
  dialect.unary = [](Op op, std::string_view a) {
    if (op == Op::neg) return fmt::format("-{}", a);
    if (op == Op::sgn) return fmt::format("_sign({})", a);
    return op == Op::abs ? fmt::format("abs({})", a) : fmt::format("math.{}({})", op_name(op), a);
  };
  dialect.binary = [](Op op, std::string_view a, std::string_view b) {
    return op == Op::pow ? fmt::format("math.pow({}, {})", a, b)
                         : fmt::format("{} {} {}", a, op_name(op), b);
  };
  dialect.indent = "        ";
  const CodeSource source = code.source();
  const Statements body = write_statements(source, dialect);
  std::string arguments;
  for (const std::string& argument : code.arguments()) arguments += argument + ", ";
  std::string text = fmt::format(
      "# {}\n#\n{}# One number a call; where the formula is not finite, math raises. Written by "
      "tribench.\nimport math\n\n\n{}class {}:\n    def __init__(self):\n        self.init()\n\n"
      "    def init(self):\n        self.z = [0.0] * {}\n        self.slips = [False] * {}\n"
      "        self.drive = [0.0] * {}\n        self.started = False\n\n"
      "    def step(self, {}{}):\n        if self.started:\n",
      source.text, in_box_lines(code, "#"), state_code_python(code.laws()), name,
      code.formula().states.size(), code.formula().states.size(), code.drives().size(), arguments,
      code.seconds());
  std::string rest = "            self.started = True\n";
  for (std::size_t k = 0; k < code.formula().states.size(); ++k) {
    text += fmt::format("            {} = {}\n", write.memory("z", k), code.call(k, write));
    if (code.formula().states[k].law == StateLaw::lag) {
      rest += fmt::format("            {} = {}\n", write.memory("z", k),
                          code.drive_name(code.formula().states[k].drives[0]));
    }
  }
  text += "        else:\n" + rest;
  for (const std::size_t drive : code.drives()) {
    text += fmt::format("        {} = {}\n", write.memory("drive", code.drive_place(drive)),
                        code.drive_name(drive));
  }
  for (std::size_t k = 0; k < code.formula().states.size(); ++k) {
    text += fmt::format("        {} = {}\n", code.state_name(k), write.memory("z", k));
  }
  return text + sign_lines(source, dialect) + body.text +
         fmt::format("        return {}\n", body.result);
}

// MATLAB: the memory goes in and out.

struct MatlabWriter {
  std::string prefix;
  std::string at;
  std::string memory(std::string_view field, std::size_t place) const {
    return fmt::format("{}.{}({})", at, field, place + 1);
  }
  std::string slips(std::size_t k) const { return fmt::format(", {}.slips({})", at, k + 1); }
  std::string number(double value) const { return float_literal(value); }
};

std::string matlab_step(const StepCode& code) {
  const MatlabWriter write{"law_", code.memory()};
  const Dialect dialect = matlab_dialect();
  const CodeSource source = code.source();
  const Statements body = write_statements(source, dialect);
  std::string arguments;
  for (const std::string& argument : code.arguments()) arguments += argument + ", ";
  const std::size_t count = code.formula().states.size();
  std::string text = fmt::format(
      "function [tau, {0}] = {1}({0}, {2}{3})\n% {4}\n%\n{5}"
      "% init: {0} = []. One sample a call. Written by tribench.\n"
      "  if isempty({0})\n    {0} = struct('z', zeros(1, {6}), 'slips', zeros(1, {6}), "
      "'drive', zeros(1, {7}));\n",
      code.memory(), code.options().function, arguments, code.seconds(), source.text,
      in_box_lines(code, "%"), count, code.drives().size());
  std::string moving;
  for (std::size_t k = 0; k < count; ++k) {
    const StateDeclaration& state = code.formula().states[k];
    if (state.law == StateLaw::gms) {
      moving += fmt::format("    [{}, {}.slips({})] = {};\n", write.memory("z", k), code.memory(),
                            k + 1, code.call(k, write));
    } else {
      moving += fmt::format("    {} = {};\n", write.memory("z", k), code.call(k, write));
    }
    if (state.law == StateLaw::lag) {
      text += fmt::format("    {} = {};\n", write.memory("z", k), code.drive_name(state.drives[0]));
    }
  }
  text += "  else\n" + moving + "  end\n";
  for (const std::size_t drive : code.drives()) {
    text += fmt::format("  {} = {};\n", write.memory("drive", code.drive_place(drive)),
                        code.drive_name(drive));
  }
  for (std::size_t k = 0; k < count; ++k) {
    text += fmt::format("  {} = {};\n", code.state_name(k), write.memory("z", k));
  }
  return text + sign_lines(source, dialect) + body.text +
         fmt::format("  tau = {};\nend\n{}{}", body.result, matlab_helpers(source, body),
                     state_code_matlab(code.laws()));
}

}  // namespace

std::string export_stateful(const StatefulFormula& formula, std::span<const std::string> names,
                            CodeForm form, const StatefulExportOptions& options) {
  require_function_name(options.function);
  if (options.single && form != CodeForm::c) {
    throw_bad_input("only C has single precision", "--single", "leave it out, or say --as c");
  }
  const StepCode code(formula, names, options);
  switch (form) {
    case CodeForm::c:
      return c_step(code);
    case CodeForm::python:
      return python_step(code);
    case CodeForm::matlab:
      return matlab_step(code);
    default:
      throw_bad_input("a formula with states has no such form", "--as",
                      "c, python and matlab have a step");
  }
}

}  // namespace tribench
