// SPDX-License-Identifier: MIT
#include "algorithms/pysr/simplify.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/pysr/factor.hpp"
#include "algorithms/pysr/tape_edit.hpp"

namespace tribench::pysr {
namespace {

using Tape = std::vector<Node>;

bool is_value(const Tape& tape, double value) {
  return tape.size() == 1 && tape[0].is_constant() && tape[0].value == value;
}
bool is_constant(const Tape& tape) { return tape.size() == 1 && tape[0].is_constant(); }

Tape constant(double value) { return {Node::constant(value)}; }

double value_of(const Tape& tape) {
  Evaluator evaluator;
  return evaluator.evaluate_at(Expression(tape), {});
}

// Where the root of `tape` is op with a constant argument: that constant's place, else size().
std::size_t constant_argument(const Tape& tape, Op op) {
  if (tape.size() < 3 || tape.back().op != op) return tape.size();
  const std::size_t right = tape.size() - 2;
  if (tape[right].is_constant()) return right;
  const std::size_t left = right - tape[right].length;
  return tape[left].is_constant() && tape[left].length == 1 ? left : tape.size();
}

// op(a, b) with op + or *, where a constant on one side meets one inside the other: true where a is
// then the whole. Where both sides hold one, they meet in a, and op(a, b) still has to be formed.
bool merge_constants(Op op, Tape& a, Tape& b) {
  Tape* value = is_constant(a) ? &a : (is_constant(b) ? &b : nullptr);
  Tape& other = value == &a ? b : a;
  const auto combine = [op](double x, double y) { return op == Op::add ? x + y : x * y; };
  if (value != nullptr) {
    const std::size_t place = constant_argument(other, op);
    if (place == other.size()) return false;
    other[place].value = combine(other[place].value, (*value)[0].value);
    if (&other == &b) std::swap(a, b);
    return true;
  }
  const std::size_t in_a = constant_argument(a, op);
  const std::size_t in_b = constant_argument(b, op);
  if (in_a == a.size() || in_b == b.size()) return false;
  a[in_a].value = combine(a[in_a].value, b[in_b].value);
  Tape rest;  // b without its constant: the other argument
  if (in_b + 2 == b.size()) {
    rest.assign(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(in_b));
  } else {
    rest.assign(b.begin() + 1, b.end() - 1);
  }
  b = std::move(rest);
  return false;
}

Tape simplified_tape(std::span<const Node> tape);

Tape joined(Op op, Tape a, Tape b) {
  if (op == Op::sub) {
    if (is_value(b, 0)) return a;
    if (a == b) return constant(0);
    if (is_constant(b)) return joined(Op::add, std::move(a), constant(-b[0].value));
  }
  if (op == Op::add) {
    if (is_value(a, 0)) return b;
    if (is_value(b, 0)) return a;
  }
  if (op == Op::mul) {
    if (is_value(a, 0) || is_value(b, 0)) return constant(0);
    if (is_value(a, 1)) return b;
    if (is_value(b, 1)) return a;
  }
  if (op == Op::div) {
    if (is_value(b, 1)) return a;
    if (is_constant(b) && b[0].value != 0) {
      return joined(Op::mul, std::move(a), constant(1 / b[0].value));
    }
  }
  if (op == Op::pow && is_value(b, 1)) return a;
  if ((op == Op::add || op == Op::mul) && merge_constants(op, a, b)) return a;
  // A rewritten whole is smaller, so that simplifying it in turn ends.
  if (op == Op::add || op == Op::sub) {
    if (auto factored = factored_sum(op, a, b)) return simplified_tape(*factored);
  }
  if (op == Op::mul) {
    if (auto merged = merged_exponentials(a, b)) return simplified_tape(*merged);
  }
  return join(op, a, b);
}

Tape simplified_tape(std::span<const Node> tape) {
  std::vector<Tape> stack;
  for (const Node& node : tape) {
    if (arity(node.op) == 0) {
      stack.push_back({node});
      continue;
    }
    Tape last = std::move(stack.back());
    stack.pop_back();
    bool constant_arguments = is_constant(last);
    Tape result;
    if (arity(node.op) == 1) {
      result = join(node.op, last);
    } else {
      Tape first = std::move(stack.back());
      stack.pop_back();
      constant_arguments = constant_arguments && is_constant(first);
      result = constant_arguments ? join(node.op, first, last)
                                  : joined(node.op, std::move(first), std::move(last));
    }
    if (constant_arguments) {
      // What is not finite stays as it is written and fails when it is evaluated.
      const double value = value_of(result);
      if (std::isfinite(value)) result = constant(value);
    }
    stack.push_back(std::move(result));
  }
  return std::move(stack.back());
}

std::uint64_t mixed(std::uint64_t x) {
  // The finaliser of splitmix64 (Steele, Lea, Flood 2014).
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

std::uint64_t combined(Op op, std::uint64_t a, std::uint64_t b) {
  return mixed(a + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(op) + 1) + mixed(b + 17));
}

}  // namespace

Expression simplified(const Expression& formula) {
  return Expression(simplified_tape(formula.nodes()));
}

std::uint64_t structure_hash(const Expression& formula) {
  std::vector<std::uint64_t> stack;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_constant()) {
      const std::uint64_t value =
          is_exponent(formula, i) ? std::bit_cast<std::uint64_t>(node.value) : 0;
      stack.push_back(combined(node.op, value, 1));
    } else if (node.is_variable()) {
      stack.push_back(combined(node.op, node.variable, 2));
    } else if (arity(node.op) == 1) {
      stack.back() = combined(node.op, stack.back(), 3);
    } else {
      std::uint64_t b = stack.back();
      stack.pop_back();
      std::uint64_t a = stack.back();
      // With a free constant in the formula x - y and x + y differ by its sign only where y has
      // one; kept apart.
      if ((node.op == Op::add || node.op == Op::mul) && b < a) std::swap(a, b);
      stack.back() = combined(node.op, a, b);
    }
  }
  return stack.back();
}

}  // namespace tribench::pysr
