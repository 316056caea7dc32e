// SPDX-License-Identifier: MIT
//
// Two rewrites that make a formula smaller without changing its values but by rounding:
// a common factor of two summands is taken out, and a product of exponentials is the exponential
// of a sum. Neither adds a place where the formula is not finite.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench::pysr {

// a op b (+ or -) as factor * (a' op b'); none where they share no factor but constants, or the
// result would not be smaller.
std::optional<std::vector<Node>> factored_sum(Op op, std::span<const Node> a,
                                              std::span<const Node> b);

// a * b with the exponential factors of both in one; none where not both have one.
std::optional<std::vector<Node>> merged_exponentials(std::span<const Node> a,
                                                     std::span<const Node> b);

}  // namespace tribench::pysr
