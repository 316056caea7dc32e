// SPDX-License-Identifier: MIT
#include "algorithms/expression/operator_set.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {

OperatorSet::OperatorSet(std::string name, std::string summary, std::vector<Op> operators,
                         bool proved_free_only)
    : name_(std::move(name)),
      summary_(std::move(summary)),
      operators_(std::move(operators)),
      proved_free_only_(proved_free_only) {
  for (const Op op : operators_) mask_ |= 1U << static_cast<int>(op);
}

bool OperatorSet::admits(const Expression& formula) const {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (arity(node.op) == 0 || allows(node.op)) continue;
    if (node.op == Op::neg && allows(Op::sub)) continue;
    if (node.op == Op::pow && allows(Op::mul)) {
      const Node& exponent = formula.node(formula.last_child(i));
      if (exponent.is_constant() && exponent.value >= 2 && exponent.value <= 64 &&
          exponent.value == std::floor(exponent.value)) {
        continue;
      }
    }
    return false;
  }
  return true;
}

const std::vector<OperatorSet>& operator_sets() {
  using enum Op;
  static const std::vector<OperatorSet> kSets = {
      {"paper",
       "+ - * exp sqrt, the paper's set; integer powers are products",
       {add, sub, mul, exp, sqrt}},
      {"paper+div", "the paper's set and division", {add, sub, mul, div, exp, sqrt}},
      {"paper+safe_div",
       "with division, only formulas proved free of singularities",
       {add, sub, mul, div, exp, sqrt},
       true},
      {"koza",
       "+ - * / exp log sin cos, the usual set of the Nguyen problems",
       {add, sub, mul, div, exp, log, sin, cos}},
      {"full",
       "+ - * / ^ exp log sqrt abs sin cos tanh atan",
       {add, sub, mul, div, pow, exp, log, sqrt, abs, sin, cos, tanh, atan}},
  };
  return kSets;
}

const OperatorSet& find_operator_set(std::string_view name) {
  std::vector<std::string> names;
  for (const OperatorSet& set : operator_sets()) {
    if (set.name() == name) return set;
    names.push_back(set.name());
  }
  throw_bad_input(fmt::format("there is no operator set '{}'", name), {},
                  did_you_mean(name, names));
}

}  // namespace tribench
