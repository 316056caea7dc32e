// SPDX-License-Identifier: MIT
//
// Monomials in the inputs and in the values of the base functions: the words of ParFam's rational
// functions.
//
// Source: Scholl et al. 2023, section 2; the published program takes all exponent tuples of total
// degree <= d with a cap on each variable, the constant included.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::parfam {

// One exponent per variable.
using Monomial = std::vector<int>;

// All monomials of total degree <= degree with exponent j <= caps[j], by degree and then in
// reverse lexicographic order: 1, x0, x1, x0^2, x0 x1, x1^2, ...
std::vector<Monomial> monomials_up_to(int degree, std::span<const int> caps);
// How many these are, without making them: of a thousand variables there are half a million of
// degree 2. Exact up to 2^53.
double monomial_count(int degree, std::span<const int> caps);

// x0^e0 x1^e1 ... row by row; columns[j] holds variable j.
std::vector<double> monomial_values(const Monomial& monomial,
                                    std::span<const double* const> columns, std::size_t rows);

// sum_k coefficients[k] monomials[k] over the given formulas for the variables, with common factors
// taken out greedily so that it counts as few operations as may be; empty where all coefficients
// are 0.
Expression polynomial_formula(std::span<const Monomial> monomials,
                              std::span<const double> coefficients,
                              std::span<const Expression> variables);

}  // namespace tribench::parfam
