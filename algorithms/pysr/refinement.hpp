// SPDX-License-Identifier: MIT
//
// What becomes of the hall of fame before anyone sees it: every formula's constants are brought to
// convergence on all rows, the most promising ones are grown and pruned by description length, and
// what is left is a front.
#pragma once

#include <functional>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/pysr/growth.hpp"
#include "algorithms/pysr/scorer.hpp"
#include "algorithms/pysr/selection.hpp"

namespace tribench::pysr {

struct Candidate {
  Expression formula;
  FrontPoint point;  // size is the paper's complexity
};

class Refinement {
 public:
  // rows: all of them. library: terms on the same rows.
  Refinement(const Options& options, const OperatorSet& operators, const Validator& validator,
             const Rows& rows, const TermLibrary& library, bool fit_exponents);

  // Whether a formula may enter the front beyond what the validator says (a proof); all may by
  // default.
  void require(std::function<bool(const Expression&)> admitted) { admitted_ = std::move(admitted); }

  // Polished, refined and reduced to what no other beats in both complexity and loss, by
  // increasing complexity. Deterministic; ends early with the budget.
  std::vector<Candidate> front_of(const std::vector<Member>& members, RandomStream random,
                                  Budget& budget);

 private:
  bool offer(Expression formula, Budget& budget);
  void climb(std::size_t start, RandomStream& random, Budget& budget);
  std::optional<Candidate> polished(Expression formula, Budget& budget);
  std::vector<Candidate> pareto() const;

  const Options& options_;
  const Validator& validator_;
  const Rows& rows_;
  Scorer scorer_;
  Grower grower_;
  Differentiator differentiator_;
  std::function<bool(const Expression&)> admitted_;
  std::vector<Candidate> candidates_;
  std::vector<std::uint64_t> seen_;  // sorted hashes of the structures tried
};

}  // namespace tribench::pysr
