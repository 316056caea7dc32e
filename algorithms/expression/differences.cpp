// SPDX-License-Identifier: MIT
#include "algorithms/expression/differences.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"

namespace tribench {
namespace {

// Minus the formula, without a node more: where a number in a product or quotient is negative.
std::optional<Expression> opposite(const Expression& formula) {
  const std::size_t root = formula.size() - 1;
  const Node& node = formula.node(root);
  if (node.is_constant()) {
    return node.value < 0 ? std::optional(Expression::constant(-node.value)) : std::nullopt;
  }
  if (node.op == Op::neg) return subtree(formula, root - 1);
  if (node.op != Op::mul && node.op != Op::div) return std::nullopt;
  const Expression right = subtree(formula, root - 1);
  const Expression left = subtree(formula, formula.begin(root - 1) - 1);
  if (auto turned = opposite(left)) return Expression::binary(node.op, *turned, right);
  if (auto turned = opposite(right)) return Expression::binary(node.op, left, *turned);
  return std::nullopt;
}

Expression difference(Op op, const Expression& left, const Expression& right) {
  if (auto turned = opposite(right)) {
    return difference(op == Op::add ? Op::sub : Op::add, left, *turned);
  }
  if (op == Op::add) {
    if (auto turned = opposite(left)) return difference(Op::sub, right, *turned);
  }
  return Expression::binary(op, left, right);
}

}  // namespace

Expression with_differences(const Expression& formula) {
  std::vector<Expression> done;
  for (const Node& node : formula.nodes()) {
    if (node.is_constant() || node.is_variable()) {
      done.push_back(Expression({node}));
      continue;
    }
    Expression last = std::move(done.back());
    done.pop_back();
    if (arity(node.op) == 1) {
      done.push_back(Expression::unary(node.op, last));
      continue;
    }
    const Expression left = std::move(done.back());
    done.pop_back();
    const bool is_sum = node.op == Op::add || node.op == Op::sub;
    done.push_back(is_sum ? difference(node.op, left, last)
                          : Expression::binary(node.op, left, last));
  }
  return std::move(done.back());
}

}  // namespace tribench
