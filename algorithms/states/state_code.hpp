// SPDX-License-Identifier: MIT
//
// The laws of state_law.hpp as text of other languages, operation by operation those of
// law_step.hpp: what state_export puts before its step. Tests hold them together bit by bit (C) or
// to 1e-9 (Python, MATLAB).
#pragma once

#include <set>
#include <string>

#include "algorithms/states/state_law.hpp"

namespace tribench {

// Static functions NAME_exp, NAME_sign, NAME_lugre, ...; `single`: in float.
std::string state_code_c(const std::string& name, bool single, const std::set<StateLaw>& laws);
std::string state_code_python(const std::set<StateLaw>& laws);
std::string state_code_matlab(const std::set<StateLaw>& laws);

}  // namespace tribench
