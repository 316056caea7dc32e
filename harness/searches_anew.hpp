// SPDX-License-Identifier: MIT
//
// How much searching few rows bear: the search that was made is made again without a fifth of
// the movements (of the rows, where none are named), five times, its fronts judged on what was held
// out (fitting/search_validation.hpp), and the most typical of the six choices stands. For budgets
// that shall be spent: it costs five searches.
//
// Not for exact formulas, nor for models with states, nor on fewer rows than say anything.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

// Five searches that may spend a quarter of what the first one did.
inline constexpr int kSearchesAnew = 5;
inline constexpr double kOfTheFirst = 0.25;
// What the first one may spend of a budget so that they can be made.
inline constexpr double kShareBesideSearchesAnew = 1 / (1 + kSearchesAnew * kOfTheFirst);
// CPU seconds in which a search of few rows has mostly come to its end: less is not shared.
inline constexpr double kSecondsOfSearch = 10;

// A fit of other rows with a part of the budget; its front finished (finished_front.hpp).
using SearchOfRows = std::function<FitResult(const TrainingData&, RandomStream, Budget&)>;

struct Bearable {
  int complexity = 0;  // of what is chosen, at most
  // Whether a wider search may find more than noise: what this one chooses errs no plainly more on
  // rows that it has not seen than on those that it has.
  bool is_more_worth_it = true;
  std::vector<Expression> choices;  // of the searches made anew, within that complexity
};

// Whether each search may spend at least a quarter of what the first one did: what was left of the
// budget before and after it. What is not the same search says nothing of it.
bool is_enough_for_searches_anew(const BudgetLimits& before, const BudgetLimits& after);

// `fit`: what the search made of all rows. Each search may spend an equal part of the budget. None
// where nothing is to be looked at, or one of them has no answer.
std::optional<Bearable> bearable_search(const FitResult& fit, const SearchOfRows& search,
                                        const TrainingData& data, Budget& budget,
                                        const RandomStream& random);

// Whether a formula of the front explains the rows exactly (fitting/exact_choice.hpp).
bool holds_exact(const FitResult& fit, const TrainingData& data);

// Chooses the most accurate of the front within the bound where the choice is beyond it; then,
// where another search's choice is more typical of them all, that one, which joins the front with
// its constants fitted to all rows. Exact formulas stay. The note says so, and where more searching
// is not worth it.
void keep_bearable(const Bearable& bearable, const TrainingData& data, FitResult& fit);

}  // namespace tribench
