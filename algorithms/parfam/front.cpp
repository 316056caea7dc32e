// SPDX-License-Identifier: MIT
#include "algorithms/parfam/front.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/description_length.hpp"

namespace tribench::parfam {
namespace {

constexpr int kPolishIterations = 8;
constexpr std::uint64_t kPassesPerIteration = 3;  // a trial and its derivatives
// What a formula must win over the next smaller one to be in the front: more than rounding.
constexpr double kWorthwhile = 1 - 1e-9;

// Schwarz's penalty takes the form as given; that each constant was chosen from alternatives is
// paid for with one bit (as Chen & Chen 2008 do, less strictly).
constexpr double kChoiceCost = 0.693147180559945;
constexpr double kLeastVariance = 1e-24;  // of the target's square: rounding

// Constants but for whole exponents, which are structure.
std::size_t count_parameters(const Expression& formula) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const bool exponent = i + 1 < formula.size() && formula.node(i + 1).op == Op::pow;
    if (formula.node(i).is_constant() && !exponent) ++count;
  }
  return count;
}

}  // namespace

Front::Front(const FiniteRows& data, FitContext& context) : data_(data), context_(context) {
  for (double y : data.target) target_squares_ += y * y;
}

bool Front::is_proved(const Expression& formula) const {
  if (!context_.operators.proved_free_only()) return true;
  InputBox box;
  for (const Input& input : context_.data.inputs) {
    box.push_back({input.low, input.high, input.sign_of});
  }
  return prove_free(formula, box).verdict == Verdict::proved_free;
}

void Front::offer(Expression formula) {
  if (!context_.operators.admits(formula)) return;
  const std::uint64_t cost =
      (kPassesPerIteration * kPolishIterations + 3) * node_rows(formula, data_.rows());
  if (!context_.budget.spend(cost)) return;
  const ConstantFitResult fit =
      fitter_.fit(formula, data_.table(), data_.target, {},
                  {.max_iterations = kPolishIterations, .step_tolerance = 1e-12});
  if (fit.status == FitStatus::not_finite || !std::isfinite(fit.sum_squares)) return;
  Member member{std::move(formula), 0, fit.sum_squares, 0};
  member.complexity = paper_complexity(member.formula);
  for (const Member& other : members_) {
    if (other.complexity <= member.complexity && other.sum_squares <= member.sum_squares) return;
  }
  if (!is_proved(member.formula)) return;
  member.description_length =
      description_length(member.formula, data_.table(), data_.target, differentiator_);
  const auto n = static_cast<double>(data_.rows());
  const double variance = std::max(member.sum_squares, kLeastVariance * target_squares_) / n;
  member.bic =
      0.5 * n * std::log(variance) +
      (0.5 * std::log(n) + kChoiceCost) * static_cast<double>(count_parameters(member.formula));
  std::erase_if(members_, [&](const Member& other) {
    return other.complexity >= member.complexity && other.sum_squares >= member.sum_squares;
  });
  if (member.sum_squares < least_) {
    least_ = member.sum_squares;
    if (context_.progress != nullptr) {
      context_.progress->improved(least_ / static_cast<double>(data_.rows()),
                                  context_.budget.spent());
    }
  }
  members_.push_back(std::move(member));
}

std::size_t Front::choose(const std::vector<const Member*>& front, Choice choice) const {
  if (choice == Choice::cross_validation) {
    std::vector<Expression> formulas;
    for (const Member* member : front) formulas.push_back(member->formula);
    return cross_validate(formulas, data_.table(), data_.target, data_.movement).chosen;
  }
  const auto criterion = [&](const Member* member) {
    return choice == Choice::bic ? member->bic : member->description_length;
  };
  return static_cast<std::size_t>(std::ranges::min_element(front, {}, criterion) - front.begin());
}

FitResult Front::result(Choice choice) {
  std::ranges::sort(members_, {}, &Member::complexity);
  FitResult result;
  result.reason = context_.budget.exhausted() ? StopReason::budget : StopReason::converged;
  double least = std::numeric_limits<double>::infinity();
  std::vector<const Member*> front;
  for (const Member& member : members_) {
    if (!(member.sum_squares < kWorthwhile * least)) continue;
    least = member.sum_squares;
    front.push_back(&member);
  }
  for (const Member* member : front) result.front.push_back(member->formula);
  if (!front.empty()) result.chosen = choose(front, choice);
  return result;
}

}  // namespace tribench::parfam
