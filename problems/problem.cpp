// SPDX-License-Identifier: MIT
#include "problems/problem.hpp"

namespace tribench {

std::vector<std::string> Problem::input_names() const {
  std::vector<std::string> names;
  names.reserve(inputs.size());
  for (const Input& input : inputs) names.push_back(input.name);
  return names;
}

std::string Problem::true_law() const {
  std::string whole;
  for (const Stage& stage : stages) {
    if (stage.law.empty()) return {};
    whole += whole.empty() ? stage.law : " + (" + stage.law + ")";
  }
  return whole;
}

}  // namespace tribench
