// SPDX-License-Identifier: MIT
//
// A look at the choice of a search on few rows: the same search made again without a fifth of the
// movements (of the rows, where none are named), five times, its fronts judged on what was held out
// (fitting/search_validation.hpp). For budgets that shall be spent: it costs five searches.
//
// Not where the front holds an exact formula, nor for models with states, nor on fewer rows than
// say anything.
#pragma once

#include <functional>

#include "algorithms/regressor.hpp"

namespace tribench {

// A fit of other rows with a part of the budget; its front finished (finished_front.hpp).
using SearchOfRows = std::function<FitResult(const TrainingData&, RandomStream, Budget&)>;

// May change `fit.chosen`, and then says so in its note. Each search may spend an equal part of
// what is left. The choice stands where one of them has no answer.
void look_at_choice(FitResult& fit, const SearchOfRows& search, const TrainingData& data,
                    Budget& budget, const RandomStream& random);

}  // namespace tribench
