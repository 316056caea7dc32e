// SPDX-License-Identifier: MIT
//
// Formulas that are equal to a given one on a box, one rewrite away: what the canonical form
// (canonical.hpp) does not decide because it can go either way. A search over these is
// simplify.hpp.
//
//   sums       a common factor, or number, of some terms taken out; a term that is nothing beside
//              the others dropped
//   products   a factor that is a sum multiplied out, or scaled by numbers beside it and by the
//              constants of exponents; exponentials and roots merged; x sgn_x = |x|,
//              |x| sgn_x = x; beside a sign its square in another factor 1
//   functions  exp of log and of a constant term, log of exp, of roots and powers, roots of squares
//              and of constants, |x| of what has one sign, quarter turns in sines and cosines; sin,
//              tanh, atan, exp and cos of arguments so small, tanh of ones so large, that the
//              difference is below 1e-12 of the value
//
//   powers     power_rewrites.hpp
//
// A rewrite that needs a fact (a range, a sign) is offered where the box proves it. Values on the
// box change by rounding, and by kNegligible of themselves where something is left out.
#pragma once

#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/interval.hpp"
#include "algorithms/expression/power_rewrites.hpp"
#include "algorithms/expression/sum_of_products.hpp"

namespace tribench {

class Rewriter {
 public:
  explicit Rewriter(const InputBox& box)
      : box_(box), range_([this](const Expression& formula) { return range(formula); }) {}
  Rewriter(const Rewriter&) = delete;
  Rewriter& operator=(const Rewriter&) = delete;

  // No two orders alike: the same formula gives the same list.
  std::vector<Expression> rewrites(const Expression& formula) const;

 private:
  void rewrite_sum(const SumOfProducts& sum, std::vector<Expression>& out) const;
  void drop_negligible(const SumOfProducts& sum, std::vector<Expression>& out) const;
  void rewrite_product(const SumTerm& term, std::vector<Expression>& out) const;
  void use_sign(const SumTerm& term, std::vector<Expression>& out) const;
  void merge_pairs(const SumTerm& term, std::vector<Expression>& out) const;
  void rewrite_function(Op op, const Expression& argument, std::vector<Expression>& out) const;
  void rewrite_exp(const Expression& argument, std::vector<Expression>& out) const;
  void rewrite_log(const Expression& argument, std::vector<Expression>& out) const;
  void rewrite_sqrt(const Expression& argument, std::vector<Expression>& out) const;
  void replace_small(Op op, const Expression& argument, std::vector<Expression>& out) const;

  // Of the formula's value on the box; entire where it may not be finite.
  Interval range(const Expression& formula) const;
  bool is_sign_of(const Expression& sign, const Expression& whole) const;

  const InputBox& box_;
  const RangeOf range_;
};

}  // namespace tribench
