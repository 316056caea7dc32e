// SPDX-License-Identifier: MIT
#include "algorithms/pysr/factor.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/pysr/tape_edit.hpp"

namespace tribench::pysr {
namespace {

using Tape = std::vector<Node>;
using Nodes = std::span<const Node>;

// base^power; power 1 for anything that is not a whole power.
struct Factor {
  Nodes base;
  int power = 1;
};

Nodes left_of(Nodes tape) { return tape.first(tape.size() - 1 - tape[tape.size() - 2].length); }
Nodes right_of(Nodes tape) {
  const std::size_t length = tape[tape.size() - 2].length;
  return tape.subspan(tape.size() - 1 - length, length);
}

void collect(Nodes tape, std::vector<Factor>& factors) {
  if (tape.back().op == Op::mul) {
    collect(left_of(tape), factors);
    collect(right_of(tape), factors);
    return;
  }
  if (tape.back().op == Op::pow) {
    const Node& exponent = tape[tape.size() - 2];
    if (exponent.is_constant() && exponent.value >= 2 && exponent.value <= 64 &&
        exponent.value == std::floor(exponent.value)) {
      factors.push_back({left_of(tape), static_cast<int>(exponent.value)});
      return;
    }
  }
  factors.push_back({tape, 1});
}

Tape product_of(std::span<const Factor> factors) {
  Tape product;
  for (const Factor& factor : factors) {
    if (factor.power == 0) continue;
    Tape piece(factor.base.begin(), factor.base.end());
    if (factor.power > 1) {
      const Node exponent = Node::constant(factor.power);
      piece = join(Op::pow, piece, {&exponent, 1});
    }
    product = product.empty() ? std::move(piece) : join(Op::mul, product, piece);
  }
  if (product.empty()) product.push_back(Node::constant(1));
  return product;
}

bool is_constant(Nodes tape) { return tape.size() == 1 && tape[0].is_constant(); }

// The argument of the first exponential among the factors, which is taken out.
std::optional<Tape> take_exponential(std::vector<Factor>& factors) {
  for (Factor& factor : factors) {
    if (factor.base.back().op != Op::exp || factor.power != 1) continue;
    factor.power = 0;
    return Tape(factor.base.begin(), factor.base.end() - 1);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Tape> factored_sum(Op op, Nodes a, Nodes b) {
  std::vector<Factor> of_a;
  std::vector<Factor> of_b;
  collect(a, of_a);
  collect(b, of_b);
  for (Factor& x : of_a) {
    if (is_constant(x.base)) continue;
    const auto y = std::ranges::find_if(
        of_b, [&](const Factor& factor) { return std::ranges::equal(factor.base, x.base); });
    if (y == of_b.end()) continue;
    const Factor common{x.base, std::min(x.power, y->power)};
    x.power -= common.power;
    y->power -= common.power;
    const Tape rest_a = product_of(of_a);
    const Tape rest_b = product_of(of_b);
    // Two constants become one where the sum is folded.
    const std::size_t folded = is_constant(rest_a) && is_constant(rest_b) ? 2 : 0;
    Tape result = join(Op::mul, product_of({&common, 1}), join(op, rest_a, rest_b));
    if (result.size() - folded < a.size() + b.size() + 1) return result;
    return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Tape> merged_exponentials(Nodes a, Nodes b) {
  std::vector<Factor> of_a;
  std::vector<Factor> of_b;
  collect(a, of_a);
  collect(b, of_b);
  const std::optional<Tape> first = take_exponential(of_a);
  if (!first) return std::nullopt;
  const std::optional<Tape> second = take_exponential(of_b);
  if (!second) return std::nullopt;
  const Tape exponential = join(Op::exp, join(Op::add, *first, *second));
  std::vector<Factor> factors = of_a;
  factors.insert(factors.end(), of_b.begin(), of_b.end());
  factors.push_back({exponential, 1});
  return product_of(factors);
}

}  // namespace tribench::pysr
