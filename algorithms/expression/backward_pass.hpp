// SPDX-License-Identifier: MIT
//
// The way back through one block of rows: from the adjoint of the root to those of the leaves.
// Every node of a tree has one parent, so an adjoint is written once and never added to. Internal
// to the room.
#pragma once

#include <cstddef>

#include "algorithms/expression/derivative_block.hpp"
#include "algorithms/expression/derivative_plan.hpp"

namespace tribench {

class BackwardPass {
 public:
  // Of a block whose values stand, of n rows; leaves the leaves' adjoints there.
  BackwardPass(const DerivativePlan& plan, DerivativeBlock& block, std::size_t n)
      : plan_(plan), block_(block), n_(n) {}
  void run();

 private:
  // Each from the adjoint of a place to those of its children.
  void product(std::size_t place);
  void quotient(std::size_t place);
  void power(std::size_t place);
  void base(std::size_t place);
  void exponent(std::size_t place);
  void unary(std::size_t place);

  const DerivativePlan& plan_;
  DerivativeBlock& block_;
  std::size_t n_;
};

}  // namespace tribench
