// SPDX-License-Identifier: MIT
#include "algorithms/admission.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/expression/singularity.hpp"

namespace tribench {

InputBox input_box(std::span<const Input> inputs) {
  InputBox box;
  for (const Input& input : inputs) {
    const bool has_owner = input.sign_of && *input.sign_of < inputs.size();
    box.push_back({input.low, input.high, has_owner ? input.sign_of : std::nullopt});
  }
  return box;
}

int degree_in(const Expression& formula, std::size_t input) {
  std::vector<int> degree(formula.size());
  const auto bounded = [](int value) { return std::min(value, kUnboundedDegree); };
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    const int arguments = arity(node.op);
    if (arguments == 0) {
      degree[i] = node.is_variable() && node.variable == input ? 1 : 0;
      continue;
    }
    const int right = degree[formula.last_child(i)];
    const int left = arguments == 2 ? degree[formula.left_child(i)] : 0;
    if (node.op == Op::mul || node.op == Op::div) {
      degree[i] = bounded(left + right);
    } else if (node.op == Op::pow && (left > 0 || right > 0)) {
      const Node& exponent = formula.node(formula.last_child(i));
      const bool whole = exponent.is_constant() && exponent.value >= 1 &&
                         exponent.value <= kUnboundedDegree &&
                         exponent.value == std::floor(exponent.value);
      degree[i] = whole ? bounded(left * static_cast<int>(exponent.value)) : kUnboundedDegree;
    } else {
      degree[i] = std::max(left, right);
    }
  }
  return degree.empty() ? 0 : degree.back();
}

bool keeps_priors(const Expression& formula, std::span<const Input> inputs) {
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    if (inputs[j].max_degree > 0 && degree_in(formula, j) > inputs[j].max_degree) return false;
  }
  return true;
}

bool Admission::may_be_offered(const Expression& formula) const {
  return keeps_priors(formula, inputs_) &&
         (!operators_.proved_free_only() ||
          prove_free(formula, box_).verdict == Verdict::proved_free);
}

}  // namespace tribench
