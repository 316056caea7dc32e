// SPDX-License-Identifier: MIT
//
// What follows a search over declared states: their parameters and the formula's constants fitted
// together on the training rows (algorithms/states/stateful_fit), and the result judged again.
#pragma once

#include <string>
#include <vector>

#include "harness/cell_task.hpp"
#include "problems/problem.hpp"

namespace tribench {

// The problem with the states that a user declares (`z = dahl(v, sliding=1e-4)`) among the inputs
// that methods may use. Throws Error (bad_input) where a text is no declaration or there is no
// time.
Problem with_declared_states(const Problem& problem, const std::vector<std::string>& declarations);

// problem: without such states. Changes the chosen formula, its record and its place in the front,
// where it has states and fitting them makes its training error smaller.
void refit_states(const Problem& problem, CellResult& result);

}  // namespace tribench
