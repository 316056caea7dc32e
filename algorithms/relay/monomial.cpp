// SPDX-License-Identifier: MIT
#include "algorithms/relay/monomial.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/build.hpp"

namespace tribench::relay {

bool Monomial::is_defined(const LogRows& rows) const {
  return std::ranges::all_of(powers, [&](const auto& each) {
    const Factor& x = rows.inputs()[each.first];
    const bool is_root = std::abs(each.second) == 0.5;
    return (each.second > 0 || x.has_logs()) && !(is_root && std::ranges::min(x.values) < 0);
  });
}

std::vector<double> Monomial::values(const LogRows& rows) const {
  std::vector<double> product(rows.rows(), 1.0);
  for (const auto& [j, power] : powers) {
    const std::vector<double>& x = rows.inputs()[j].values;
    for (std::size_t r = 0; r < product.size(); ++r) {
      const double size = std::abs(power) == 0.5 ? std::sqrt(x[r])
                          : std::abs(power) == 1 ? x[r]
                                                 : x[r] * x[r];
      product[r] = power > 0 ? product[r] * size : product[r] / size;
    }
  }
  return product;
}

Expression Monomial::times(double factor) const {
  using namespace build;
  Expression product = constant(factor);
  for (const auto& [j, power] : powers) {
    const Expression x = input(j);
    const Expression size = std::abs(power) == 0.5 ? function(Op::sqrt, x)
                            : std::abs(power) == 1 ? x
                                                   : x * x;
    product = power > 0 ? product * size : product / size;
  }
  return product;
}

std::vector<Monomial> monomials(const std::vector<std::vector<double>>& powers,
                                const LogRows& rows) {
  std::vector<Monomial> list;
  const std::size_t inputs = rows.inputs().size();
  for (const std::vector<double>& each : powers) {
    if (each.size() > inputs) continue;
    std::vector<char> is_taken(inputs, 0);
    std::fill_n(is_taken.begin(), each.size(), char{1});
    do {
      Monomial product;
      for (std::size_t j = 0; j < inputs; ++j) {
        if (is_taken[j]) product.powers.emplace_back(j, each[product.powers.size()]);
      }
      if (product.is_defined(rows)) list.push_back(std::move(product));
    } while (std::ranges::prev_permutation(is_taken).found);
  }
  return list;
}

}  // namespace tribench::relay
