// SPDX-License-Identifier: MIT
#include "harness/searches_anew.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/exact_choice.hpp"
#include "algorithms/fitting/held_out_choice.hpp"
#include "algorithms/fitting/search_validation.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewestRows = 20;  // four of them held out

bool is_worth_a_look(const FitResult& fit, const FiniteRows& rows) {
  return fit.front.size() > 1 && fit.states.empty() && !fit.keeps_form && !fit.keeps_choice &&
         rows.rows() >= kFewestRows && rows.rows() <= kFewRows &&
         !simplest_exact(fit.front, rows.table(), rows.target);
}

// The choice, or where it is more complex than that, the last formula within the bound.
std::size_t choice_within(int complexity, const FitResult& fit) {
  const auto is_within = [complexity](const Expression& formula) {
    return paper_complexity(formula) <= complexity;
  };
  if (is_within(fit.front[fit.chosen])) return fit.chosen;
  const auto within = static_cast<std::size_t>(std::ranges::count_if(fit.front, is_within));
  return within > 0 ? within - 1 : 0;
}

void say(FitResult& fit, std::string_view what) {
  fit.note += fmt::format("{}{}", fit.note.empty() ? "" : "; ", what);
}

void keep_within(int complexity, FitResult& fit) {
  const std::size_t within = choice_within(complexity, fit);
  if (within == fit.chosen) return;
  fit.chosen = within;
  say(fit, fmt::format("no choice of more than {} operations: such err more on rows held out",
                       complexity));
}

// `searched`: what the searches made anew chose.
void keep_typical(std::span<const Expression> searched, const FiniteRows& rows, FitResult& fit) {
  if (searched.empty()) return;
  std::vector<Expression> candidates = {fit.front[fit.chosen]};
  candidates.insert(candidates.end(), searched.begin(), searched.end());
  const std::size_t typical = most_typical(candidates, searched, rows.table());
  if (typical == 0) return;
  Expression formula = std::move(candidates[typical]);
  ConstantFitter().fit(formula, rows.table(), rows.target);
  const auto place =
      std::ranges::upper_bound(fit.front, paper_complexity(formula), {}, &paper_complexity);
  fit.chosen = static_cast<std::size_t>(place - fit.front.begin());
  fit.front.insert(place, std::move(formula));
  say(fit,
      "chosen: of five searches without a fifth of the rows each, what is nearest to the "
      "median of what they found");
}

}  // namespace

bool is_enough_for_searches_anew(const BudgetLimits& before, const BudgetLimits& after) {
  const auto is_enough = [](double had, double has) {
    return !std::isfinite(had) || has / kSearchesAnew >= kOfTheFirst * (had - has);
  };
  return is_enough(static_cast<double>(before.evaluations),
                   static_cast<double>(after.evaluations)) &&
         is_enough(before.cpu_seconds, after.cpu_seconds);
}

std::optional<Bearable> bearable_search(const FitResult& fit, const SearchOfRows& search,
                                        const TrainingData& data, Budget& budget,
                                        const RandomStream& random) {
  const FiniteRows rows(data);
  if (!is_worth_a_look(fit, rows)) return std::nullopt;
  const std::span<const int> movements =
      data.movement.empty() ? std::span<const int>() : rows.movement;
  const std::vector<int> fold_of = held_out_folds(movements, rows.rows(), kSearchesAnew);
  SearchValidation validation;
  std::vector<FitResult> searches;
  for (int fold = 0; fold < kSearchesAnew; ++fold) {
    const FiniteRows held_out(rows, [&](std::size_t row) { return fold_of[row] == fold; });
    if (held_out.rows() == 0) continue;  // fewer movements than folds
    const FiniteRows kept(rows, [&](std::size_t row) { return fold_of[row] != fold; });
    const auto left = static_cast<std::uint64_t>(kSearchesAnew - fold);
    Budget part = budget.share(budget.remaining() / left, 1.0 / static_cast<double>(left));
    FitResult anew =
        search(kept.as_data(data.inputs), random.split(static_cast<std::uint64_t>(fold)), part);
    budget.settle(part);
    if (anew.front.empty()) return std::nullopt;
    validation.add(anew.front, anew.chosen, held_out.table(), held_out.target);
    searches.push_back(std::move(anew));
  }
  const ErrorSum seen =
      Evaluator().sum_squared_errors(fit.front[fit.chosen], rows.table(), rows.target);
  Bearable bearable{
      validation.bound(fit.front, fit.chosen),
      validation.mean_square() * static_cast<double>(rows.rows()) <= kPlainly * seen.sum,
      {}};
  for (const FitResult& anew : searches) {
    bearable.choices.push_back(anew.front[choice_within(bearable.complexity, anew)]);
  }
  return bearable;
}

bool holds_exact(const FitResult& fit, const TrainingData& data) {
  const FiniteRows rows(data);
  return simplest_exact(fit.front, rows.table(), rows.target).has_value();
}

void keep_bearable(const Bearable& bearable, const TrainingData& data, FitResult& fit) {
  if (fit.front.empty()) return;
  if (!bearable.is_more_worth_it) {
    say(fit, "no wider search: what this one chooses errs twice as much on rows held out from it");
  }
  if (holds_exact(fit, data)) return;
  keep_within(bearable.complexity, fit);
  keep_typical(bearable.choices, FiniteRows(data), fit);
}

}  // namespace tribench
