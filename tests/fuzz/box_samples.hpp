// SPDX-License-Identifier: MIT
//
// Points of an input box: what a proof about the whole box is held against.
#pragma once

#include <vector>

#include "algorithms/expression/input_box.hpp"

namespace tribench::fuzz {

// Ends, 0 and its neighbours, the middle and pseudo-random points of each range; signs follow the
// inputs that they are of. The same points for the same box.
std::vector<std::vector<double>> samples_of(const InputBox& box, std::size_t count);

}  // namespace tribench::fuzz
