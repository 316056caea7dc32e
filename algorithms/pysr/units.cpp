// SPDX-License-Identifier: MIT
#include "algorithms/pysr/units.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>

#include "foundation/error.hpp"

namespace tribench::pysr {
namespace {

struct NamedUnit {
  std::string_view symbol;
  std::array<double, 7> power;
};

constexpr std::array<NamedUnit, 22> kUnits = {{
    {"-", {}},
    {"1", {}},
    {"rad", {}},
    {"deg", {}},
    {"m", {1}},
    {"mm", {1}},
    {"kg", {0, 1}},
    {"g", {0, 1}},
    {"s", {0, 0, 1}},
    {"ms", {0, 0, 1}},
    {"min", {0, 0, 1}},
    {"Hz", {0, 0, -1}},
    {"A", {0, 0, 0, 1}},
    {"mA", {0, 0, 0, 1}},
    {"K", {0, 0, 0, 0, 1}},
    {"degC", {0, 0, 0, 0, 1}},
    {"N", {1, 1, -2}},
    {"Nm", {2, 1, -2}},
    {"J", {2, 1, -2}},
    {"W", {2, 1, -3}},
    {"V", {2, 1, -3, -1}},
    {"Pa", {-1, 1, -2}},
}};

const NamedUnit* find_unit(std::string_view symbol) {
  for (const NamedUnit& unit : kUnits) {
    if (unit.symbol == symbol) return &unit;
  }
  return nullptr;
}

// One factor: a symbol with an optional whole power, "s^2" or "s^-1".
void multiply_factor(Dimension& dimension, std::string_view factor, double direction,
                     std::string_view whole) {
  double power = direction;
  const std::size_t caret = factor.find('^');
  if (caret != std::string_view::npos) {
    int exponent = 0;
    const char* last = factor.data() + factor.size();
    const auto read = std::from_chars(factor.data() + caret + 1, last, exponent);
    if (read.ec != std::errc() || read.ptr != last) {
      throw_bad_input(fmt::format("the unit '{}' has a power that is not whole", whole));
    }
    power *= exponent;
  }
  const std::string_view symbol = factor.substr(0, caret);
  const NamedUnit* unit = find_unit(symbol);
  if (unit == nullptr) {
    throw_bad_input(fmt::format("the unit '{}' has the unknown symbol '{}'", whole, symbol), {},
                    "use SI symbols such as N m, rad/s, m/s^2, A, V, K");
  }
  for (std::size_t k = 0; k < 7; ++k) dimension.power[k] += power * unit->power[k];
}

using Result = std::optional<Dimension>;

Result sum_of(const Dimension& a, const Dimension& b) {
  if (a.same_powers(b)) return Dimension{a.power, a.wildcard && b.wildcard};
  if (a.wildcard) return b;
  if (b.wildcard) return a;
  return std::nullopt;
}

Dimension product_of(const Dimension& a, const Dimension& b, double sign) {
  Dimension result{a.power, a.wildcard || b.wildcard};
  for (std::size_t k = 0; k < 7; ++k) result.power[k] += sign * b.power[k];
  return result;
}

Dimension scaled(const Dimension& a, double factor) {
  Dimension result = a;
  for (double& power : result.power) power *= factor;
  return result;
}

bool is_number(const Dimension& a) { return a.wildcard || a.same_powers(Dimension{}); }

Result power_of(const Dimension& a, const Dimension& b, const Node& exponent) {
  if (exponent.is_constant() && exponent.value == std::floor(exponent.value)) {
    return scaled(a, exponent.value);
  }
  if (!is_number(a) || !is_number(b)) return std::nullopt;
  return Dimension{};
}

Result function_of(Op op, const Dimension& a) {
  switch (op) {
    case Op::neg:
    case Op::abs:
      return a;
    case Op::sqrt:
      return scaled(a, 0.5);
    case Op::sgn:
      return Dimension{};
    default:
      return is_number(a) ? Result(Dimension{}) : std::nullopt;
  }
}

Result operation_of(const Node& node, const Dimension& a, const Dimension& b,
                    const Node& right_node) {
  switch (node.op) {
    case Op::add:
    case Op::sub:
      return sum_of(a, b);
    case Op::mul:
      return product_of(a, b, 1);
    case Op::div:
      return product_of(a, b, -1);
    default:
      return power_of(a, b, right_node);
  }
}

}  // namespace

Dimension parse_unit(std::string_view text) {
  Dimension dimension;
  double direction = 1;
  std::size_t i = 0;
  while (i < text.size()) {
    const char c = text[i];
    if (c == ' ' || c == '*' || c == '(' || c == ')') {
      ++i;
    } else if (c == '/') {
      direction = -1;  // everything after a stroke is below it, as in N m s/rad
      ++i;
    } else {
      const std::size_t end = std::min(text.find_first_of(" */()", i), text.size());
      multiply_factor(dimension, text.substr(i, end - i), direction, text);
      i = end;
    }
  }
  return dimension;
}

Result dimension_of(const Expression& formula, std::span<const Dimension> inputs) {
  std::vector<Dimension> stack;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_constant()) {
      stack.push_back({{}, true});
    } else if (node.is_variable()) {
      stack.push_back(inputs[node.variable]);
    } else {
      const Dimension last = stack.back();
      stack.pop_back();
      Result result;
      if (arity(node.op) == 1) {
        result = function_of(node.op, last);
      } else {
        result = operation_of(node, stack.back(), last, formula.node(i - 1));
        stack.pop_back();
      }
      if (!result) return std::nullopt;
      stack.push_back(*result);
    }
  }
  return stack.back();
}

bool units_agree(const Expression& formula, std::span<const Dimension> inputs,
                 const std::optional<Dimension>& target) {
  const Result dimension = dimension_of(formula, inputs);
  if (!dimension) return false;
  return !target || dimension->wildcard || dimension->same_powers(*target);
}

}  // namespace tribench::pysr
