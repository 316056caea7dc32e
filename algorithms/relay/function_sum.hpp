// SPDX-License-Identifier: MIT
//
// One function of a scaled product whose sizes other inputs set:
//
//   y = b(x) + c(x) f(a u),   u = prod x_j^p_j,
//
// with b and c sums of terms and f one of the functions that laws are made of (unit_function.hpp).
// What goes from one level to another with a third quantity: Stribeck's curve with its forces among
// the inputs, Newton's cooling, a dose and its response, Debye's relaxation, a cell's current.
//
// For every product u, every f and some scales a one regression on some of the rows; b's part of it
// is taken off once. The best are refined by golden sections, and what is exact loses the terms
// that it does without.
// Source: separable least squares, Golub and Pereyra 1973.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// few: b of 1, the inputs and products of two; c of 1 and the inputs; u of one or two inputs. Some
// 0.1 s for four inputs. many: u of three inputs; then b and c of 1, the inputs, products and
// ratios of two, and u of one to three. Up to seconds; the budget ends it.
enum class SumTerms { few, many };

// Exact to rounding, or nearly so: several ways to write one law differ in length, and a sum of
// many terms may come near to a law that it is not. None where none is, and where there are not 2
// to 6 inputs and 60 rows.
std::vector<Expression> find_function_sums(const LogRows& rows, const OperatorSet& operators,
                                           SumTerms terms, Budget& budget);

// Under noise, the same in all rows: those that leave least, with few terms, to be fitted and
// weighed by the caller. Some 0.2 s for four inputs.
std::vector<Expression> likely_function_sums(const LogRows& rows, const OperatorSet& operators,
                                             Budget& budget);

}  // namespace tribench::relay
