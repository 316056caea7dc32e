// SPDX-License-Identifier: MIT
#include "problems/problem.hpp"

namespace tribench {

std::vector<std::string> Problem::input_names() const {
  std::vector<std::string> names;
  names.reserve(inputs.size());
  for (const Input& input : inputs) names.push_back(input.name);
  return names;
}

}  // namespace tribench
