// SPDX-License-Identifier: MIT
//
// What is left of many laws once their products are taken off: T(y) = x^p (c_0 + c_1 f(a x^q)),
// with T one of y, 1/y, y^2, 1/y^2, p and q small fractions, f one of exp, tanh, atan, log(1 + .),
// powers of 1 + ., e^. + e^-. and e^. - e^-. Planck's law, the efficiency of a fin, an Arrhenius
// rate with a prefactor, the field on the axis of a disk; where a is below 0, what has a limit that
// x stays below, as a speed below that of light.
//
// All combinations are tried on few rows and a coarse grid of a, where c_0 and c_1 are solved for;
// the best are fitted. Finds nothing where there is noise (product_search.hpp says why).
// Cost: some 50 ms.
#pragma once

#include <optional>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

// Over the first input of `rows`, which is nowhere 0, with roots of it where it is positive; exact
// to rounding, of those the shortest; none where none is.
std::optional<Expression> find_scaled_function(const LogRows& rows, const OperatorSet& operators,
                                               Budget& budget);

}  // namespace tribench::relay
