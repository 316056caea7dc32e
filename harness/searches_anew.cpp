// SPDX-License-Identifier: MIT
#include "harness/searches_anew.hpp"

#include <fmt/format.h>

#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/exact_choice.hpp"
#include "algorithms/fitting/held_out_choice.hpp"
#include "algorithms/fitting/search_validation.hpp"

namespace tribench {
namespace {

constexpr int kFolds = 5;
constexpr std::size_t kFewestRows = 20;  // four of them held out

bool is_worth_a_look(const FitResult& fit, const FiniteRows& rows) {
  return fit.front.size() > 1 && fit.states.empty() && !fit.keeps_form &&
         rows.rows() >= kFewestRows && rows.rows() <= kFewRows &&
         !simplest_exact(fit.front, rows.table(), rows.target);
}

}  // namespace

void look_at_choice(FitResult& fit, const SearchOfRows& search, const TrainingData& data,
                    Budget& budget, const RandomStream& random) {
  const FiniteRows rows(data);
  if (!is_worth_a_look(fit, rows)) return;
  const std::vector<int> fold_of = held_out_folds(
      data.movement.empty() ? std::span<const int>() : rows.movement, rows.rows(), kFolds);
  SearchValidation validation;
  for (int fold = 0; fold < kFolds; ++fold) {
    const FiniteRows held_out(rows, [&](std::size_t row) { return fold_of[row] == fold; });
    if (held_out.rows() == 0) continue;  // fewer movements than folds
    const FiniteRows kept(rows, [&](std::size_t row) { return fold_of[row] != fold; });
    const auto left = static_cast<std::uint64_t>(kFolds - fold);
    Budget part = budget.share(budget.remaining() / left, 1.0 / static_cast<double>(left));
    const FitResult anew =
        search(kept.as_data(data.inputs), random.split(static_cast<std::uint64_t>(fold)), part);
    budget.settle(part);
    if (anew.front.empty()) return;
    validation.add(anew.front, anew.chosen, held_out.table(), held_out.target);
  }
  const std::size_t choice = validation.choice(fit.front, fit.chosen);
  if (choice == fit.chosen) return;
  fit.chosen = choice;
  fit.note +=
      fmt::format("{}simpler than the search's choice, which errs more on rows held out from it",
                  fit.note.empty() ? "" : "; ");
}

}  // namespace tribench
