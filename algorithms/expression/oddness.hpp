// SPDX-License-Identifier: MIT
//
// Whether a formula is odd in its velocity: friction that is the same both ways. Part of
// property.hpp, which is what others include.
#pragma once

#include <cstddef>

#include "algorithms/expression/property.hpp"

namespace tribench {

// Of a formula that is proved finite on the box. Odd where f(v) + f(-v) cancels; refuted where it
// is certainly not 0 at one of some hundred points.
PropertyResult prove_odd(const Expression& formula, const InputBox& box, std::size_t velocity);

}  // namespace tribench
