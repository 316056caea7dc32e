// SPDX-License-Identifier: MIT
#include "algorithms/fitting/shape_dimension.hpp"

#include <vector>

namespace tribench {
namespace {

struct Shape {
  std::size_t dimension = 1;
  bool has_offset = false;  // a constant of its own among its terms
  bool is_constant = false;
};

Shape unary_shape(Op op, const Shape& a) {
  switch (op) {
    case Op::neg:
      return a;
    case Op::abs:
    case Op::sqrt:
    case Op::sgn:
      return {a.dimension, false};
    case Op::exp:
      return {1 + a.dimension - (a.has_offset ? 1U : 0U), false};
    default:
      return {1 + a.dimension, false};
  }
}

Shape binary_shape(Op op, const Shape& a, const Shape& b, bool constant_exponent) {
  switch (op) {
    case Op::add:
    case Op::sub:
      // Two offsets are one.
      return {a.dimension + b.dimension - (a.has_offset && b.has_offset ? 1U : 0U),
              a.has_offset || b.has_offset};
    case Op::pow:
      return {a.dimension + (constant_exponent ? 0U : b.dimension), false};
    default:
      // Of (v + 1) * (s + 2) the offset is no number of its own.
      return {a.dimension + b.dimension - 1,
              (a.is_constant && b.has_offset) || (b.is_constant && a.has_offset)};
  }
}

}  // namespace

std::size_t shape_dimension(const Expression& formula) {
  std::vector<Shape> stack;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (arity(node.op) == 0) {
      stack.push_back({1, node.is_constant(), node.is_constant()});
    } else if (arity(node.op) == 1) {
      stack.back() = unary_shape(node.op, stack.back());
    } else {
      const Shape b = stack.back();
      stack.pop_back();
      stack.back() = binary_shape(node.op, stack.back(), b, formula.node(i - 1).is_constant());
    }
  }
  return stack.empty() ? 0 : stack.back().dimension;
}

}  // namespace tribench
