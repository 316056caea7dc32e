// SPDX-License-Identifier: MIT
//
// What looking would find: whether a formula is finite at every point of a regular grid over the
// box. Not a proof of anything; it is there to be compared with one.
#pragma once

#include <cstddef>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

// About `points` points (their k-th root along each of the k inputs that the formula uses), end
// points included; signs follow their inputs. Throws Error (bad_input) where the box is none.
bool is_finite_on_grid(const Expression& formula, const InputBox& box, std::size_t points = 2001);

}  // namespace tribench
