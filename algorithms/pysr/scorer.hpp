// SPDX-License-Identifier: MIT
//
// What a formula costs: its loss on rows, with or without its constants fitted first. The one
// place of the search that spends the budget on formulas.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/pysr/constraints.hpp"
#include "algorithms/pysr/member.hpp"
#include "algorithms/pysr/rows.hpp"

namespace tribench::pysr {

// Mean square of the target: the loss of the constant 0.
double zero_loss(const Rows& rows);

// What losses are divided by: the loss of the constant 0 where it is finite and at least `floor`.
// The original's floor is 0.01; ours is 0 (the problem's own scale), unless the loss is 0 too.
double loss_norm(const Rows& rows, double floor);

// How a loss becomes a cost.
struct ScoreRule {
  double norm = 1;       // what losses are divided by
  double parsimony = 0;  // the published price of a node
  // Ours, where above 0: the number of rows. The loss then grows by the factor that makes up for
  // the evidence its constants and nodes cost: exp(2 (p / 2 ln n + k / 2) / n).
  std::size_t evidence_rows = 0;
  bool fit_exponents = false;
};

// Keeps its workspace between calls. One per thread.
class Scorer {
 public:
  Scorer(const Validator& validator, const ScoreRule& rule) : validator_(&validator), rule_(rule) {}

  // Mean squared error; none where the formula is not finite on every row, or where the budget has
  // run out (budget.exhausted() tells).
  std::optional<double> mean_square(const Expression& formula, const Rows& rows, Budget& budget);

  // As above, after at most `iterations` steps of Levenberg-Marquardt, fewer where the budget
  // allows no more.
  std::optional<double> fit(Expression& formula, const Rows& rows, int iterations, Budget& budget);

  // The member with its size, loss (plus the penalty of its units) and cost.
  Member member_of(Expression formula, double mean_square) const;

 private:
  const Validator* validator_;
  ScoreRule rule_;
  Evaluator evaluator_;
  ConstantFitter fitter_;
  std::vector<double> values_;
};

}  // namespace tribench::pysr
