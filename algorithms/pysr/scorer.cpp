// SPDX-License-Identifier: MIT
#include "algorithms/pysr/scorer.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "foundation/elementary.hpp"

namespace tribench::pysr {
namespace {

// A step costs at most a trial evaluation and a Jacobian of twice that; a start costs as much.
constexpr std::uint64_t kStepCost = 3;

}  // namespace

double zero_loss(const Rows& rows) {
  return columns::dot(rows.target.data(), rows.target.data(), rows.size()) /
         static_cast<double>(rows.size());
}

double loss_norm(const Rows& rows, double floor) {
  const double baseline = zero_loss(rows);
  if (std::isfinite(baseline) && baseline >= floor && baseline > 0) return baseline;
  return floor > 0 ? floor : 1;
}

std::optional<double> Scorer::mean_square(const Expression& formula, const Rows& rows,
                                          Budget& budget) {
  if (!budget.spend(node_rows(formula, rows.size()))) return std::nullopt;
  values_.resize(rows.size());
  evaluator_.evaluate(formula, rows.inputs(), values_);
  columns::sub(values_.data(), rows.target.data(), values_.data(), rows.size());
  const double sum = columns::dot(values_.data(), values_.data(), rows.size());
  if (!std::isfinite(sum)) return std::nullopt;
  return sum / static_cast<double>(rows.size());
}

std::optional<double> Scorer::fit(Expression& formula, const Rows& rows, int iterations,
                                  Budget& budget) {
  const std::uint64_t pass = node_rows(formula, rows.size());
  const std::uint64_t affordable = budget.remaining() / std::max<std::uint64_t>(pass, 1);
  ConstantFitOptions options;
  options.max_iterations = iterations;
  options.exponents = rule_.fit_exponents ? FitExponents::all : FitExponents::none;
  if (affordable < kStepCost * static_cast<std::uint64_t>(iterations + 1)) {
    options.max_iterations = static_cast<int>(affordable / kStepCost) - 1;
  }
  if (options.max_iterations < 1) return mean_square(formula, rows, budget);
  if (budget.exhausted()) return std::nullopt;
  const ConstantFitResult result = fitter_.fit(formula, rows.inputs(), rows.target, {}, options);
  if (!budget.spend(result.node_rows) || !std::isfinite(result.sum_squares)) return std::nullopt;
  return result.sum_squares / static_cast<double>(rows.size());
}

Member Scorer::member_of(Expression formula, double mean_square) const {
  Member member;
  member.size = validator_->size(formula);
  member.loss = mean_square + validator_->unit_penalty(formula);
  member.cost = member.loss / rule_.norm + rule_.parsimony * member.size;
  if (rule_.evidence_rows > 0) {
    const double price = evidence_price(formula, rule_.evidence_rows);
    member.cost *= elementary::exp(2 * price / static_cast<double>(rule_.evidence_rows));
  }
  member.formula = std::move(formula);
  return member;
}

}  // namespace tribench::pysr
