// SPDX-License-Identifier: MIT
//
// A formula as a sum of products, and back: what rewrites of sums and products work on. Nothing is
// rounded but numbers that stand in one product, which become one.
//
// Not a canonical form (canonical.hpp): terms and factors keep their order, equal terms stay apart.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// Whether the operation joins terms.
constexpr bool is_sum(Op op) { return op == Op::add || op == Op::sub; }

struct TermFactor {
  Expression base;
  int power = 1;  // not 0
};
struct SumTerm {
  double coefficient = 1;
  std::vector<TermFactor> factors;  // different bases on either side of the bar
};
using SumOfProducts = std::vector<SumTerm>;

// The node that ends at i; a product has one term.
SumOfProducts sum_of_products(const Expression& formula, std::size_t i);

Expression formula_of(const SumTerm& term);
Expression formula_of(const SumOfProducts& sum);

// Numbers go to the coefficient where that stays finite, equal bases become one power.
void multiply_by(SumTerm& term, TermFactor factor);
SumTerm product_of(const SumTerm& a, const SumTerm& b);

// base^power, without a power of 1; power >= 1.
Expression power_of(const Expression& base, int power);

}  // namespace tribench
