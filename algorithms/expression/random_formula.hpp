// SPDX-License-Identifier: MIT
//
// Random formulas of a wanted size over an operator set: for search, tests and benches.
//
// A size that the operators cannot reach (an even number of nodes with binary operators alone) is
// lowered by one. Nothing is checked for being finite or sensible. Postfix nodes are appended to a
// tape that the caller keeps, so that no memory is allocated once it has grown.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "foundation/random.hpp"

namespace tribench {

struct LeafOptions {
  double constant_probability = 0.5;  // else a variable, uniformly
  double constant_scale = 1;          // constants are N(0, scale^2)
};

class RandomFormulas {
 public:
  // Operators are drawn uniformly. variables >= 1, or constant_probability = 1.
  RandomFormulas(std::vector<Op> operators, std::size_t variables, LeafOptions leaves = {});
  RandomFormulas(const OperatorSet& operators, std::size_t variables, LeafOptions leaves = {})
      : RandomFormulas(operators.operators(), variables, leaves) {}

  Node leaf(RandomStream& random) const;
  // An operator of this arity; throws Error (failed) where the set has none.
  Op operation(int arity, RandomStream& random) const;

  // Breadth first: every level is filled before the next, so that depth grows with the logarithm
  // of the size. Source: Burlacu, Kronberger, Kommenda 2020 (Operon), the balanced tree creator.
  Expression balanced(std::size_t size, RandomStream& random) const;

  // Depth first; a binary operator divides the nodes that are left uniformly between its sides.
  Expression grown(std::size_t size, RandomStream& random) const;
  void append_grown(std::size_t size, RandomStream& random, std::vector<Node>& tape) const;

 private:
  std::size_t reachable(std::size_t size) const;
  const std::vector<Op>& operators_of(std::size_t size) const;

  std::vector<Op> unary_;
  std::vector<Op> binary_;
  std::vector<Op> all_;
  std::size_t variables_;
  LeafOptions leaves_;
};

}  // namespace tribench
