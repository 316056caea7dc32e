// SPDX-License-Identifier: MIT
//
// C, Python, MATLAB: one operation a statement.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/export_forms.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

// Collects statements; every new name is one prefix and a number.
class Writer {
 public:
  Writer(const CodeSource& source, const Dialect& dialect) : dialect_(dialect) {
    // An input called t3 must not meet a temporary.
    const auto clashes = [&](const CodeInputs::Argument& each) {
      return each.code_name.starts_with(prefix_);
    };
    const auto& arguments = source.inputs.arguments;
    while (std::any_of(arguments.begin(), arguments.end(), clashes)) prefix_.push_back('_');
  }

  std::string assign(const std::string& value) {
    std::string name = fmt::format("{}{}", prefix_, statements_.operations++);
    statements_.text += fmt::format("{}{}{} = {}{}\n", dialect_.indent, dialect_.declare, name,
                                    value, dialect_.terminate);
    return name;
  }

  std::string power(const std::string& base, int exponent) {
    std::string result;  // empty: 1
    std::string square = base;
    for (int left = std::abs(exponent); left > 0; left >>= 1) {
      if ((left & 1) != 0) {
        result = result.empty() ? square : assign(dialect_.binary(Op::mul, result, square));
      }
      if (left > 1) square = assign(dialect_.binary(Op::mul, square, square));
    }
    if (result.empty()) return dialect_.literal(1);
    return exponent < 0 ? assign(dialect_.binary(Op::div, dialect_.literal(1), result)) : result;
  }

  Statements finish(std::string result) {
    statements_.result = std::move(result);
    return std::move(statements_);
  }

 private:
  const Dialect& dialect_;
  std::string prefix_ = "t";
  Statements statements_;
};

bool uses(const CodeSource& source, Op op) {
  const auto nodes = source.formula.nodes();
  return std::any_of(nodes.begin(), nodes.end(), [op](const Node& node) { return node.op == op; });
}

// An argument of the box that the formula does without would be warned of.
std::string unused_lines(const CodeSource& source) {
  std::string text;
  for (std::size_t i = 0; i < source.inputs.arguments.size(); ++i) {
    const bool used = std::any_of(
        source.inputs.columns.begin(), source.inputs.columns.end(),
        [i](const CodeInputs::Column& each) { return each.is_used && each.argument == i; });
    if (!used) text += fmt::format("  (void){};\n", source.inputs.arguments[i].code_name);
  }
  return text;
}

std::string infix(Op op, std::string_view a, std::string_view b, std::string_view dot = {}) {
  const bool elementwise = op == Op::mul || op == Op::div;
  return fmt::format("{} {}{} {}", a, elementwise ? dot : "", op_name(op), b);
}

// Whether the inputs are inside the box, for a controller to ask before it trusts the value.
std::string c_box_check(const CodeSource& source) {
  std::string tests;
  for (const CodeInputs::Argument& argument : source.inputs.arguments) {
    if (!argument.range) continue;
    tests += fmt::format("{}({} >= {}) & ({} <= {})", tests.empty() ? "" : " & ",
                         argument.code_name, float_literal(argument.range->low), argument.code_name,
                         float_literal(argument.range->high));
  }
  if (tests.empty()) return {};
  return fmt::format(
      "\n/* 1 where the inputs are inside the box above, else 0 (also for NaN). */\n"
      "int {}_in_box({}) {{\n  return {};\n}}\n",
      source.function, source.inputs.argument_list("double "), tests);
}

}  // namespace

std::string ranges_comment(const CodeSource& source, std::string_view mark) {
  std::string text;
  bool any = false;
  for (const CodeInputs::Argument& argument : source.inputs.arguments) {
    if (!argument.range) continue;
    text += fmt::format("{}   {} in [{}, {}]\n", mark, argument.code_name,
                        print_number(argument.range->low), print_number(argument.range->high));
    any = true;
  }
  return any ? fmt::format("{} Input box in which the formula was judged:\n{}", mark, text)
             : fmt::format("{} No input box was given: values outside the data are unknown.\n",
                           mark);
}

std::string sign_lines(const CodeSource& source, const Dialect& dialect) {
  std::string text;
  for (const CodeInputs::Column& column : source.inputs.columns) {
    if (!column.is_used || !column.is_sign) continue;
    const std::string& argument = source.inputs.arguments[column.argument].code_name;
    text += fmt::format("{}{}{} = {}{}\n", dialect.indent, dialect.declare, column.name,
                        dialect.unary(Op::sgn, argument), dialect.terminate);
  }
  return text;
}

bool uses_sign(const CodeSource& source) {
  return uses(source, Op::sgn) ||
         std::any_of(source.inputs.columns.begin(), source.inputs.columns.end(),
                     [](const CodeInputs::Column& each) { return each.is_used && each.is_sign; });
}

std::string CodeInputs::argument_list(std::string_view before_each) const {
  std::string text;
  for (const Argument& argument : arguments) {
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", before_each, argument.code_name);
  }
  return text;
}

std::string float_literal(double value) {
  std::string text = print_number(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return value < 0 || std::signbit(value) ? fmt::format("({})", text) : text;
}

Statements write_statements(const CodeSource& source, const Dialect& dialect) {
  Writer writer(source, dialect);
  std::vector<std::string> stack;
  for (std::size_t i = 0; i < source.formula.size(); ++i) {
    const Node& node = source.formula.node(i);
    if (node.is_constant()) {
      stack.push_back(dialect.literal(node.value));
    } else if (node.is_variable()) {
      stack.push_back(source.inputs.columns[node.variable].name);
    } else if (arity(node.op) == 1) {
      stack.back() = writer.assign(dialect.unary(node.op, stack.back()));
    } else {
      const std::string right = std::move(stack.back());
      stack.pop_back();
      const Node& exponent = source.formula.node(i - 1);
      stack.back() =
          node.op == Op::pow && exponent.is_constant() && is_product_power(exponent.value)
              ? writer.power(stack.back(), static_cast<int>(exponent.value))
              : writer.assign(dialect.binary(node.op, stack.back(), right));
    }
  }
  return writer.finish(stack.back());
}

Dialect c_dialect() {
  Dialect c;
  c.literal = float_literal;
  c.unary = [](Op op, std::string_view a) {
    if (op == Op::neg) return fmt::format("-{}", a);
    if (op == Op::sgn) return fmt::format("sign_of({})", a);
    return fmt::format("{}({})", op == Op::abs ? "fabs" : op_name(op), a);
  };
  c.binary = [](Op op, std::string_view a, std::string_view b) {
    return op == Op::pow ? fmt::format("pow({}, {})", a, b) : infix(op, a, b);
  };
  c.declare = "const double ";
  c.terminate.push_back(';');
  return c;
}

Dialect python_dialect() {
  Dialect python;
  python.literal = float_literal;
  python.unary = [](Op op, std::string_view a) {
    if (op == Op::neg) return fmt::format("-{}", a);
    const std::string_view name =
        op == Op::sgn ? "sign" : (op == Op::atan ? "arctan" : op_name(op));
    return fmt::format("np.{}({})", name, a);
  };
  python.binary = [](Op op, std::string_view a, std::string_view b) {
    if (op == Op::pow) return fmt::format("np.power({}, {})", a, b);
    // Python's own floats refuse to divide by zero; NumPy's do as IEEE 754 says.
    const bool literal = a.front() == '(' || (a.front() >= '0' && a.front() <= '9');
    return literal && op == Op::div ? infix(op, fmt::format("np.float64({})", a), b)
                                    : infix(op, a, b);
  };
  return python;
}

Dialect matlab_dialect() {
  Dialect matlab;
  matlab.literal = float_literal;
  matlab.unary = [](Op op, std::string_view a) {
    if (op == Op::neg) return fmt::format("-{}", a);
    if (op == Op::sgn) return fmt::format("sign({})", a);
    if (op == Op::sqrt || op == Op::log) return fmt::format("real_{}({})", op_name(op), a);
    return fmt::format("{}({})", op_name(op), a);
  };
  matlab.binary = [](Op op, std::string_view a, std::string_view b) {
    return op == Op::pow ? fmt::format("real_power({}, {})", a, b) : infix(op, a, b, ".");
  };
  matlab.terminate.push_back(';');
  return matlab;
}

std::string c_code(const CodeSource& source) {
  const Dialect c = c_dialect();
  const Statements body = write_statements(source, c);
  const std::string arguments = source.inputs.argument_list("double ");
  std::string text = fmt::format(
      "/* {} = {}\n *\n{} *\n"
      " * Straight-line code without state, loops, allocation or branches that depend on the\n"
      " * inputs: {} operations, the same for every input. Written by tribench. Compile without\n"
      " * -ffast-math and with -ffp-contract=off to get the values that were judged. */\n"
      "#include <math.h>\n\n",
      source.function, source.text, ranges_comment(source, " *"), body.operations);
  if (uses_sign(source)) {
    text +=
        "/* -1, 0 or 1; NaN of NaN. */\n"
        "static inline double sign_of(double x) {\n"
        "  return x != x ? x : (double)((x > 0.0) - (x < 0.0));\n}\n\n";
  }
  text += fmt::format("double {}({}) {{\n{}{}  return {};\n}}\n", source.function,
                      arguments.empty() ? std::string_view("void") : std::string_view(arguments),
                      unused_lines(source) + sign_lines(source, c), body.text, body.result);
  return text + c_box_check(source);
}

std::string python_code(const CodeSource& source) {
  Dialect python = python_dialect();
  python.indent = "        ";
  const Statements body = write_statements(source, python);
  std::string text = fmt::format(
      "# {} = {}\n#\n{}# Written by tribench. Takes numbers or arrays.\nimport numpy as np\n\n\n",
      source.function, source.text, ranges_comment(source, "#"));
  text += fmt::format("def {}({}):\n", source.function, source.inputs.argument_list());
  for (const CodeInputs::Argument& argument : source.inputs.arguments) {
    text += fmt::format("    {0} = np.asarray({0}, dtype=float)[()]\n", argument.code_name);
  }
  text += "    with np.errstate(all=\"ignore\"):\n" + sign_lines(source, python) + body.text;
  return text + fmt::format("        return np.float64({})\n", body.result);
}

std::string matlab_helpers(const CodeSource& source, const Statements& body) {
  std::string text;
  // MATLAB answers with complex numbers where the judge says NaN.
  for (const Op op : {Op::sqrt, Op::log}) {
    if (!uses(source, op)) continue;
    text += fmt::format(
        "\nfunction y = real_{0}(x)\n  y = NaN(size(x));\n  y(x >= 0) = {0}(x(x >= 0));\nend\n",
        op_name(op));
  }
  if (body.text.find("real_power(") != std::string::npos) {
    // Of the size alone: one complex element makes the whole array complex, in its last places too.
    text +=
        "\nfunction y = real_power(x, e)\n  is_negative = x < 0 | 1 ./ x < 0;\n"
        "  y = abs(x) .^ e .* (1 - 2 * (is_negative & mod(e, 2) == 1));\n"
        "  y(x < 0 & isfinite(x) & e ~= fix(e)) = NaN;\nend\n";
  }
  return text;
}

std::string matlab_code(const CodeSource& source) {
  const Dialect matlab = matlab_dialect();
  const Statements body = write_statements(source, matlab);
  std::string text = fmt::format(
      "function tau = {0}({1})\n% {0} = {2}\n%\n{3}% Written by tribench. Takes numbers or "
      "arrays.\n{4}{5}  tau = {6};\nend\n",
      source.function, source.inputs.argument_list(), source.text, ranges_comment(source, "%"),
      sign_lines(source, matlab), body.text, body.result);
  return text + matlab_helpers(source, body);
}

}  // namespace tribench
