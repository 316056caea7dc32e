// SPDX-License-Identifier: MIT
#include "harness/searches_anew.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/finite_rows.hpp"
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
  for (int fold = 0; fold < kSearchesAnew; ++fold) {
    const FiniteRows held_out(rows, [&](std::size_t row) { return fold_of[row] == fold; });
    if (held_out.rows() == 0) continue;  // fewer movements than folds
    const FiniteRows kept(rows, [&](std::size_t row) { return fold_of[row] != fold; });
    const auto left = static_cast<std::uint64_t>(kSearchesAnew - fold);
    Budget part = budget.share(budget.remaining() / left, 1.0 / static_cast<double>(left));
    const FitResult anew =
        search(kept.as_data(data.inputs), random.split(static_cast<std::uint64_t>(fold)), part);
    budget.settle(part);
    if (anew.front.empty()) return std::nullopt;
    validation.add(anew.front, anew.chosen, held_out.table(), held_out.target);
  }
  const ErrorSum seen =
      Evaluator().sum_squared_errors(fit.front[fit.chosen], rows.table(), rows.target);
  return Bearable{
      validation.bound(fit.front, fit.chosen),
      validation.mean_square() * static_cast<double>(rows.rows()) <= kPlainly * seen.sum};
}

bool holds_exact(const FitResult& fit, const TrainingData& data) {
  const FiniteRows rows(data);
  return simplest_exact(fit.front, rows.table(), rows.target).has_value();
}

void keep_within(const Bearable& bearable, const TrainingData& data, FitResult& fit) {
  if (fit.front.empty()) return;
  const auto say = [&fit](std::string_view what) {
    fit.note += fmt::format("{}{}", fit.note.empty() ? "" : "; ", what);
  };
  if (!bearable.is_more_worth_it) {
    say("no wider search: what this one chooses errs twice as much on rows held out from it");
  }
  const auto is_within = [&](const Expression& formula) {
    return paper_complexity(formula) <= bearable.complexity;
  };
  if (is_within(fit.front[fit.chosen])) return;
  if (holds_exact(fit, data)) return;
  const auto within = static_cast<std::size_t>(std::ranges::count_if(fit.front, is_within));
  fit.chosen = within > 0 ? within - 1 : 0;
  say(fmt::format("no choice of more than {} operations: such err more on rows held out",
                  bearable.complexity));
}

}  // namespace tribench
