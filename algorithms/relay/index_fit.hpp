// SPDX-License-Identifier: MIT
//
// Functions of one variable that physics is made of: T(y) = c_0 + c_1 f(a x) with T one of y, 1/y,
// y^2, 1/y^2, log y and f one of exp, log, tanh, atan, e^. + e^-., e^. - e^-., sine and cosine. The
// scale a is looked for on a grid (for waves one as fine as the rows can tell: a periodogram) and
// fitted; c_0 and c_1 are solved for.
//
// Finds nothing where there is noise (product_search.hpp says why). About 0.1 s for 500 rows.
// Source of the grid for waves: Lomb 1976, Scargle 1982.
#pragma once

#include <optional>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// Over the first input of `rows`, exact to rounding; none where none is.
std::optional<Expression> find_function(const LogRows& rows, const OperatorSet& operators,
                                        Budget& budget);

}  // namespace tribench::relay
