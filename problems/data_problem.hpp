// SPDX-License-Identifier: MIT
//
// The user's own data as a problem, and the one sign convention that data must keep: friction is
// positive with velocity.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/problem.hpp"

namespace tribench {

// One stage on all rows of `train`; the test table holds all rows of `test`, or stays empty where
// there is none. The input box is the range of all these rows: a formula has to be free of poles
// where it is tested, too. A missing input sgn_X is derived
// from X. Throws Error (bad_input) with the nearest name for an unknown column, for an input that
// is the target, is named twice or cannot stand in a formula, for a target too small to be squared,
// and where friction opposes velocity (see below).
Problem make_data_problem(const Dataset& train, const Dataset* test, const std::string& target,
                          std::span<const std::string> inputs);

// Throws Error (bad_input) where the column `target` has the role friction_torque and opposes the
// velocity (friction_sign.hpp); silent where there is no velocity or either is
// constant.
void refuse_opposing_friction(const Dataset& data, std::string_view target);

// Changes the sign of every torque-like channel, gravity included: the mend for the above.
void flip_torques(Dataset& data);

}  // namespace tribench
