// SPDX-License-Identifier: MIT
#include "algorithms/parfam/monomial_columns.hpp"

#include <algorithm>

namespace tribench::parfam {

const double* MonomialColumns::column(const Monomial& monomial) {
  Monomial key(monomial.begin(), monomial.begin() + static_cast<std::ptrdiff_t>(inputs_.size()));
  const auto found = columns_.find(key);
  if (found != columns_.end()) return found->second.data();
  std::vector<double> values = monomial_values(key, inputs_, rows_);
  return columns_.emplace(std::move(key), std::move(values)).first->second.data();
}

std::vector<MonomialGroup> group_by_functions(std::span<const Monomial> monomials,
                                              std::size_t inputs, MonomialColumns& columns) {
  std::vector<MonomialGroup> groups;
  for (std::size_t k = 0; k < monomials.size(); ++k) {
    unsigned functions = 0;
    for (std::size_t i = inputs; i < monomials[k].size(); ++i) {
      if (monomials[k][i] != 0) functions |= 1U << (i - inputs);
    }
    auto group = std::ranges::find(groups, functions, &MonomialGroup::functions);
    if (group == groups.end()) {
      groups.push_back({functions, {}, {}});
      group = groups.end() - 1;
    }
    group->columns.push_back(columns.column(monomials[k]));
    group->places.push_back(k);
  }
  return groups;
}

}  // namespace tribench::parfam
