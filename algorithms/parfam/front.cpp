// SPDX-License-Identifier: MIT
#include "algorithms/parfam/front.hpp"
#include "algorithms/admission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/description_length.hpp"
#include "algorithms/parfam/pole_guard.hpp"
#include "foundation/elementary.hpp"

namespace tribench::parfam {
namespace {

constexpr int kPolishIterations = 8;
constexpr std::uint64_t kPassesPerIteration = 3;  // a trial and its derivatives
// What a formula must win over the next smaller one to be in the front: more than rounding.
constexpr double kLess = 1 - 1e-9;

// Schwarz's penalty takes the form as given; that each constant was chosen from alternatives is
// paid for with one bit (as Chen & Chen 2008 do, less strictly).
constexpr double kChoiceCost = 0.693147180559945;
constexpr double kLeastVariance = 1e-24;  // of the target's square: rounding

// Places of the constants but for whole exponents, which are structure.
std::vector<std::size_t> parameter_places(const Expression& formula) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const bool exponent = i + 1 < formula.size() && formula.node(i + 1).op == Op::pow;
    if (formula.node(i).is_constant() && !exponent) places.push_back(i);
  }
  return places;
}

// The place of the 1 in a denominator 1 + q; nothing where the node is no such quotient.
std::optional<std::size_t> one_of_denominator(const Expression& formula, std::size_t i) {
  if (formula.node(i).op != Op::div || formula.node(i - 1).op != Op::add) return std::nullopt;
  const std::size_t place = i - 2 - formula.node(i - 2).length;
  if (formula.node(place).is_constant()) return place;
  return std::nullopt;
}

// Bounds that hold the 1 of every denominator, without which 1 + q^2 is not above 0 by
// construction; empty where there is none.
struct Held {
  std::vector<double> low;
  std::vector<double> high;
};
Held hold_denominators(const Expression& formula) {
  const std::vector<std::size_t> places = parameter_places(formula);
  Held held;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const auto one = one_of_denominator(formula, i);
    if (!one) continue;
    constexpr double kFree = std::numeric_limits<double>::infinity();
    held.low.resize(places.size(), -kFree);
    held.high.resize(places.size(), kFree);
    const auto at = static_cast<std::size_t>(std::ranges::find(places, *one) - places.begin());
    held.low[at] = held.high[at] = formula.node(*one).value;
  }
  return held;
}

}  // namespace

Front::Front(const FiniteRows& data, FitContext& context, bool proved_only)
    : data_(data), context_(context), proved_only_(proved_only) {
  for (double y : data.target) target_squares_ += y * y;
}

bool Front::is_proved(const Expression& formula) const {
  return prove_free(formula, input_box(context_.data.inputs)).verdict == Verdict::proved_free;
}

std::optional<Front::Member> Front::polished(Expression formula) {
  const Held held = hold_denominators(formula);
  const ConstantFitResult fit = fitter_.fit(formula, data_.table(), data_.target, {},
                                            {.max_iterations = kPolishIterations,
                                             .step_tolerance = 1e-12,
                                             .low = held.low,
                                             .high = held.high});
  if (fit.status == FitStatus::not_finite || !std::isfinite(fit.sum_squares)) return std::nullopt;
  const int complexity = paper_complexity(formula);
  return Member{std::move(formula), complexity, fit.sum_squares};
}

bool Front::is_beaten(const Member& member) const {
  return std::ranges::any_of(members_, [&](const Member& other) {
    return other.complexity <= member.complexity && other.sum_squares <= member.sum_squares;
  });
}

void Front::offer(Expression formula) {
  if (!context_.operators.admits(formula)) return;
  const std::uint64_t cost =
      (kPassesPerIteration * kPolishIterations + 3) * node_rows(formula, data_.rows());
  if (!context_.budget.spend(cost)) return;
  std::optional<Member> member = polished(formula);
  if (!member || is_beaten(*member)) return;
  if (proved_only_ && !is_proved(member->formula)) {
    std::vector<double> values(data_.rows());
    evaluator_.evaluate(formula, data_.table(), values);
    member->sum_squares = 0;
    for (std::size_t r = 0; r < values.size(); ++r) {
      member->sum_squares += (values[r] - data_.target[r]) * (values[r] - data_.target[r]);
    }
    member->formula = std::move(formula);
    if (!std::isfinite(member->sum_squares) || is_beaten(*member) || !is_proved(member->formula)) {
      return;
    }
  }
  enter(std::move(*member));
}

void Front::enter(Member member) {
  member.description_length =
      description_length(member.formula, data_.table(), data_.target, differentiator_);
  const auto n = static_cast<double>(data_.rows());
  const double variance = std::max(member.sum_squares, kLeastVariance * target_squares_) / n;
  member.bic = 0.5 * n * elementary::log(variance) +
               (0.5 * elementary::log(n) + kChoiceCost) *
                   static_cast<double>(parameter_places(member.formula).size());
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
  const InputBox box = input_box(context_.data.inputs);
  const bool beyond = reaches_beyond(data_.table(), box) && !context_.budget.out_of_time();
  if (choice == Choice::cross_validation || (choice == Choice::bic && beyond)) {
    std::vector<Expression> formulas;
    for (const Member* member : front) formulas.push_back(member->formula);
    return cross_validate(formulas, data_.table(), data_.target, data_.movement, box).chosen;
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
    if (!(member.sum_squares < kLess * least)) continue;
    least = member.sum_squares;
    front.push_back(&member);
  }
  for (const Member* member : front) result.front.push_back(member->formula);
  if (!front.empty()) result.chosen = choose(front, choice);
  return result;
}

}  // namespace tribench::parfam
