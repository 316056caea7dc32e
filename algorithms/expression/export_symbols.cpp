// SPDX-License-Identifier: MIT
//
// SymPy and LaTeX: a formula for reading and rearranging rather than for running.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "algorithms/expression/export_forms.hpp"
#include "algorithms/expression/infix.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

constexpr std::array<std::string_view, 20> kGreek = {
    "alpha", "beta", "gamma", "delta", "epsilon", "theta", "kappa", "lambda", "mu",  "nu",
    "xi",    "rho",  "sigma", "tau",   "phi",     "chi",   "psi",   "omega",  "eta", "zeta"};

Piece sympy_unary(Op op, const Piece& a, const Node& /*child*/) {
  if (op == Op::neg) return {fmt::format("-{}", at_least(kMinus, a)), kMinus};
  const std::string_view name = op == Op::abs ? "Abs" : (op == Op::sgn ? "sign" : op_name(op));
  return {fmt::format("sp.{}({})", name, a.text), kAtom};
}

Piece sympy_binary(Op op, const Piece& a, const Piece& b, const Node& exponent) {
  if (op != Op::pow) return write_arithmetic(op, a, b);
  // An integer exponent stays one, so that SymPy multiplies instead of taking logarithms.
  const bool whole = exponent.is_constant() && exponent.value == std::floor(exponent.value) &&
                     std::abs(exponent.value) < 1e6;
  const std::string power = whole ? fmt::format("{:.0f}", exponent.value) : at_least(kMinus, b);
  return {fmt::format("{}**{}", at_least(kAtom, a), power), kPower};
}

std::string latex_at_least(Binding wanted, const Piece& piece) {
  return at_least(wanted, piece, "\\left(", "\\right)");
}

std::string latex_number(double value, int digits) {
  std::string text = digits > 0 ? fmt::format("{:.{}g}", value, digits) : print_number(value);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  return fmt::format("{} \\cdot 10^{{{}}}", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

std::string latex_word(std::string_view word) {
  for (const std::string_view greek : kGreek) {
    if (word == greek) return fmt::format("\\{}", greek);
  }
  if (word == "qd") return "\\dot{q}";
  if (word == "qdd") return "\\ddot{q}";
  return word.size() == 1 ? std::string(word) : fmt::format("\\mathrm{{{}}}", word);
}

// tau_g -> \tau_{\mathrm{g}}; further underscores are kept within the subscript.
std::string latex_name(std::string_view name) {
  const std::size_t bar = name.find('_');
  if (bar == std::string_view::npos || bar == 0 || bar + 1 == name.size()) {
    std::string text;
    for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
    return bar == std::string_view::npos ? latex_word(name) : fmt::format("\\mathrm{{{}}}", text);
  }
  std::string subscript;
  for (const char c : name.substr(bar + 1)) {
    subscript += c == '_' ? std::string("\\_") : std::string(1, c);
  }
  return fmt::format("{}_{{\\mathrm{{{}}}}}", latex_word(name.substr(0, bar)), subscript);
}

Piece latex_unary(Op op, const Piece& a, const Node& /*child*/) {
  switch (op) {
    case Op::neg:
      return {fmt::format("-{}", latex_at_least(kMinus, a)), kMinus};
    case Op::exp:
      return {fmt::format("\\exp\\left({}\\right)", a.text), kAtom};
    case Op::sqrt:
      return {fmt::format("\\sqrt{{{}}}", a.text), kAtom};
    case Op::abs:
      return {fmt::format("\\left|{}\\right|", a.text), kAtom};
    case Op::sgn:
      return {fmt::format("\\operatorname{{sgn}}\\left({}\\right)", a.text), kAtom};
    default:
      return {fmt::format("\\{}\\left({}\\right)", op == Op::atan ? "arctan" : op_name(op), a.text),
              kAtom};
  }
}

Piece latex_binary(Op op, const Piece& a, const Piece& b, const Node& /*exponent*/) {
  switch (op) {
    case Op::add:
    case Op::sub: {
      const bool signed_right = b.text.starts_with('-');
      return {fmt::format("{} {} {}", a.text, op_name(op),
                          latex_at_least(signed_right ? kAtom : kProduct, b)),
              kSum};
    }
    case Op::mul:
      return {fmt::format("{} \\cdot {}", latex_at_least(kProduct, a),
                          latex_at_least(b.text.starts_with('-') ? kAtom : kPower, b)),
              kProduct};
    case Op::div:
      return {fmt::format("\\frac{{{}}}{{{}}}", a.text, b.text), kPower};
    default: {
      // A fraction or a power as the base of a power needs its parentheses.
      return {fmt::format("{}^{{{}}}", latex_at_least(kAtom, a), b.text), kPower};
    }
  }
}

}  // namespace

std::string sympy_code(const CodeSource& source) {
  const auto leaf = [&](const Node& node) -> Piece {
    if (node.is_variable()) return {source.inputs.columns[node.variable].name, kAtom};
    const std::string text = print_number(node.value);
    const bool whole = text.find_first_of(".en") == std::string::npos;
    return {whole ? text + ".0" : text, std::signbit(node.value) ? kMinus : kAtom};
  };
  const std::string value = write_pieces(source.formula, leaf, sympy_unary, sympy_binary);
  std::string text = fmt::format("# {} = {}\n# Written by tribench.\nimport sympy as sp\n\n",
                                 source.function, source.text);
  for (const CodeInputs::Argument& argument : source.inputs.arguments) {
    text += fmt::format("{} = sp.Symbol(\"{}\", real=True)\n", argument.code_name, argument.name);
  }
  for (const CodeInputs::Column& column : source.inputs.columns) {
    if (!column.is_used || !column.is_sign) continue;
    text += fmt::format("{} = sp.sign({})\n", column.name,
                        source.inputs.arguments[column.argument].code_name);
  }
  return text + fmt::format("{} = {}\n", source.function, value);
}

std::string latex_code(const CodeSource& source) {
  const auto leaf = [&](const Node& node) -> Piece {
    if (node.is_constant()) {
      const std::string text = latex_number(node.value, source.digits);
      const bool power = text.find("10^") != std::string::npos;
      return {text, std::signbit(node.value) ? kMinus : (power ? kProduct : kAtom)};
    }
    const CodeInputs::Column& column = source.inputs.columns[node.variable];
    const std::string name = latex_name(source.inputs.arguments[column.argument].name);
    if (!column.is_sign) return {name, kAtom};
    return {fmt::format("\\operatorname{{sgn}}\\left({}\\right)", name), kAtom};
  };
  return write_pieces(source.formula, leaf, latex_unary, latex_binary) + "\n";
}

}  // namespace tribench
