// SPDX-License-Identifier: MIT
#include "algorithms/expression/expression.hpp"

#include <algorithm>
#include <array>

#include "foundation/error.hpp"

namespace tribench {

std::string_view op_name(Op op) {
  static constexpr std::array<std::string_view, kOpCount> kNames = {
      "constant", "variable", "+",   "-",   "*",   "/",   "^",    "neg", "exp",
      "log",      "sqrt",     "abs", "sgn", "sin", "cos", "tanh", "atan"};
  return kNames[static_cast<std::size_t>(op)];
}

void throw_too_many_inputs() {
  throw_bad_input("a formula has more inputs than the 65536 it can name", "formula",
                  "leave out inputs that it does not use");
}

bool assign_lengths(std::span<Node> postfix) {
  std::size_t available = 0;  // complete subtrees to the left
  for (std::size_t i = 0; i < postfix.size(); ++i) {
    const auto children = static_cast<std::size_t>(arity(postfix[i].op));
    if (children > available) return false;
    std::uint32_t length = 1;
    std::size_t child = i;
    for (std::size_t c = 0; c < children; ++c) {
      child -= 1;
      length += postfix[child].length;
      child -= postfix[child].length - 1;
    }
    postfix[i].length = length;
    available = available - children + 1;
  }
  return available == 1;
}

Expression::Expression(std::vector<Node> postfix) : nodes_(std::move(postfix)) {
  if (!assign_lengths(nodes_)) {
    throw Error(ErrorKind::failed, "a postfix tape does not form exactly one formula");
  }
}

Expression Expression::unary(Op op, const Expression& a) {
  Expression result = a;
  result.nodes_.push_back({0, static_cast<std::uint32_t>(a.size() + 1), 0, op});
  return result;
}

Expression Expression::binary(Op op, const Expression& a, const Expression& b) {
  Expression result;
  result.nodes_.reserve(a.size() + b.size() + 1);
  result.nodes_ = a.nodes_;
  result.nodes_.insert(result.nodes_.end(), b.nodes_.begin(), b.nodes_.end());
  result.nodes_.push_back({0, static_cast<std::uint32_t>(a.size() + b.size() + 1), 0, op});
  return result;
}

void Expression::replace(std::size_t i, std::span<const Node> postfix) {
  const std::vector<Node> inserted(postfix.begin(), postfix.end());  // may alias nodes_
  const auto first = nodes_.begin() + static_cast<std::ptrdiff_t>(begin(i));
  const auto last = nodes_.begin() + static_cast<std::ptrdiff_t>(i + 1);
  const std::ptrdiff_t grow =
      static_cast<std::ptrdiff_t>(inserted.size()) - static_cast<std::ptrdiff_t>(last - first);
  // Ancestors are the nodes after i whose subtree reaches back over i.
  for (std::size_t j = i + 1; j < nodes_.size(); ++j) {
    if (begin(j) > i) continue;
    nodes_[j].length =
        static_cast<std::uint32_t>(static_cast<std::ptrdiff_t>(nodes_[j].length) + grow);
  }
  nodes_.insert(nodes_.erase(first, last), inserted.begin(), inserted.end());
}

Expression subtree(const Expression& formula, std::size_t i) {
  const std::span<const Node> part =
      formula.nodes().subspan(formula.begin(i), formula.node(i).length);
  Expression result;
  std::ranges::copy(part, result.reset(part.size()).begin());
  return result;
}

std::size_t depth(const Expression& formula) {
  std::vector<std::size_t> stack;
  std::size_t deepest = 0;
  for (const Node& node : formula.nodes()) {
    std::size_t below = 0;
    for (int c = 0; c < arity(node.op); ++c) {
      below = std::max(below, stack.back());
      stack.pop_back();
    }
    stack.push_back(below + 1);
    deepest = std::max(deepest, below + 1);
  }
  return deepest;
}

std::size_t columns_used(const Expression& formula) {
  std::size_t used = 0;
  for (const Node& node : formula.nodes()) {
    if (node.is_variable()) used = std::max<std::size_t>(used, node.variable + 1U);
  }
  return used;
}

std::vector<std::size_t> constant_positions(const Expression& formula) {
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula.node(i).is_constant()) positions.push_back(i);
  }
  return positions;
}

}  // namespace tribench
