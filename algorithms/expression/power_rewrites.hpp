// SPDX-License-Identifier: MIT
//
// Rewrites with powers, of rewrite.hpp's kind: one step, each equal to what it is made of.
//
//   sums       a^2 + 2ab + b^2 as (a + b)^2, whatever number stands before it
//   products   a^c b^c = (ab)^c, a^c b^-c = (a/b)^c, a^n / b^n = (a/b)^n; 1 / (a/b + c) = b / (a +
//              b c); (a + k b) / b = k + a / b; e^x (e^y + b)^n = (e^(y + x/n) + b e^(x/n))^n;
//              fractions within a fraction cleared
//   functions  sqrt(c/x) = sqrt(c)/sqrt(x), (c/x)^k = c^k x^-k; x^k = 1 where k log x is next to
//              nothing
#pragma once

#include <functional>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/interval.hpp"
#include "algorithms/expression/sum_of_products.hpp"

namespace tribench {

// Of a value: what is no more is left out.
inline constexpr double kNegligible = 1e-12;

// What is known of a formula's value: entire where it may not be finite.
using RangeOf = std::function<Interval(const Expression&)>;

// Each adds what it finds to `out`.
void complete_squares(const SumOfProducts& sum, std::vector<Expression>& out);
void merge_powers(const SumTerm& term, const RangeOf& range, std::vector<Expression>& out);
void merge_whole_powers(const SumTerm& term, std::vector<Expression>& out);
// x sqrt(x) = x^1.5, x x^c = x^(1 + c), x/sqrt(x) = sqrt(x)
void merge_powers_of_one_base(const SumTerm& term, const RangeOf& range,
                              std::vector<Expression>& out);
// a sqrt(b/a^2 + c) = sqrt(b + c a^2)
void take_below_root(const SumTerm& term, const RangeOf& range, std::vector<Expression>& out);
void open_denominators(const SumTerm& term, std::vector<Expression>& out);
void spread_exponentials(const SumTerm& term, std::vector<Expression>& out);
void clear_fractions(const SumTerm& term, std::vector<Expression>& out);
void take_whole_part_out(const SumTerm& term, std::vector<Expression>& out);
void turn_root(const Expression& argument, const RangeOf& range, std::vector<Expression>& out);
void rewrite_power(const Expression& base, const Expression& exponent, const RangeOf& range,
                   std::vector<Expression>& out);

}  // namespace tribench
