// SPDX-License-Identifier: MIT
#include "algorithms/fitting/linear_constants.hpp"

#include <algorithm>

namespace tribench {

std::vector<std::size_t> linear_constants(const Expression& formula,
                                          std::span<const std::size_t> places) {
  // Upwards: how many constants each subtree is linear in. Downwards: which of them survive.
  std::vector<int> count(formula.size(), 0);
  for (std::size_t place : places) count[place] = 1;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Op op = formula.node(i).op;
    if (op == Op::neg) count[i] = count[formula.last_child(i)];
    if (arity(op) != 2) continue;
    const int left = count[formula.left_child(i)];
    const int right = count[formula.last_child(i)];
    if (op == Op::add || op == Op::sub) count[i] = left + right;
    if (op == Op::mul) count[i] = std::max(left, right);
    if (op == Op::div) count[i] = left;
  }
  std::vector<char> linear(formula.size(), 0);
  linear[formula.root()] = 1;
  for (std::size_t i = formula.size(); i-- > 0;) {
    if (linear[i] == 0) continue;
    const Op op = formula.node(i).op;
    if (op == Op::neg) linear[formula.last_child(i)] = 1;
    if (arity(op) != 2 || op == Op::pow) continue;
    const std::size_t left = formula.left_child(i);
    const std::size_t right = formula.last_child(i);
    const bool sum = op == Op::add || op == Op::sub;
    const bool to_left = sum || op == Op::div || count[left] >= count[right];
    linear[left] = to_left ? 1 : 0;
    linear[right] = sum || !to_left ? 1 : 0;
  }
  std::vector<std::size_t> result;
  std::ranges::copy_if(places, std::back_inserter(result),
                       [&](std::size_t place) { return linear[place] != 0; });
  return result;
}

}  // namespace tribench
