// SPDX-License-Identifier: MIT
//
// Which constants of a formula a fit may move: all but integer exponents, which are part of its
// form. Not for a search over forms.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

// Places of the tape, increasing. O(nodes).
std::vector<std::size_t> free_constants(const Expression& formula);

}  // namespace tribench
