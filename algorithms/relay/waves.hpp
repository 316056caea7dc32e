// SPDX-License-Identifier: MIT
//
// What rings, over one variable: x^p y = c_0 + c_1 exp(a x) sin(w x + f), or two waves without
// decay; p is -1, 0, 1 or 2. A single wave without decay is index_fit's.
//
// Frequencies and decays are looked for on a grid, where the rest is solved for, the second wave
// beside the first and then the first anew; the best are fitted. Finds nothing where there is noise
// (product_search.hpp says why). Cost: some 0.1 s.
// Source of the separation: Golub and Pereyra 1973 (variable projection).
#pragma once

#include <optional>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// Over the first input of `rows`, exact to rounding; none where none is.
std::optional<Expression> find_waves(const LogRows& rows, const OperatorSet& operators,
                                     Budget& budget);

// f, where cosine cos x + sine sin x is a multiple of sin(x + f).
double phase_of(double cosine, double sine);

}  // namespace tribench::relay
