// SPDX-License-Identifier: MIT
//
// From the formula a sequence stands for to the ones worth reporting: constants where the sequence
// had no place for them, then ever fewer terms.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/differentiate.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/udsr/scoring.hpp"

namespace tribench::udsr {

// The formula with a constant 1 before every term, inside and outside of functions, that has none,
// and a constant 0 added to every sum that has none: (v + s) exp(v s - v^2) becomes
// (1 v + 1 s + 0) exp(1 v s - 1 v^2) + 0. Same values. A sequence with a linear token can hold no
// constants (prior.hpp), and the scale of what stands in an exponent is never 1.
Expression with_constants(const Expression& formula);

// The places of the constants other than exponents: what a fit moves.
std::vector<std::size_t> movable_constants(const Expression& formula);

// Removes term after term: fits all constants, then drops the term whose loss costs least to first
// order (its constant squared over its variance, Hassibi & Stork 1993), and again.
class Pruner {
 public:
  explicit Pruner(const ScoringProblem& problem) : problem_(&problem) {}

  struct Step {
    Expression formula;  // constants at their minimum
    double nrmse = 0;
  };
  // From the formula itself down to at most `fewest` terms, or as far as the seconds of `clock`
  // allow, which may be a part of the budget's.
  std::vector<Step> path(Expression formula, std::size_t fewest, Budget& budget, Budget& clock);

 private:
  // The place of the term to drop, or the size of the tape where none can be.
  std::size_t least_needed(const Expression& formula, const InTime& in_time,
                           std::uint64_t& node_rows);

  const ScoringProblem* problem_;
  ConstantFitter fitter_;
  Differentiator differentiator_;
};

// Takes the term that ends at `place` (an operand of + or -) out of the formula.
Expression without_term(const Expression& formula, std::size_t place);

}  // namespace tribench::udsr
