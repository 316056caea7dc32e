// SPDX-License-Identifier: MIT
//
// When a diagnosis that names nothing may not say that nothing is missing: then it cannot tell, and
// says what to record. Of other verdicts nothing is changed.
#pragma once

#include <string>
#include <vector>

#include "harness/loop/judged_diagnosis.hpp"

namespace tribench::loop {

// Where no movement can be foretold from the others: a base that they do not determine may hold
// anything.
void doubt_undetermined(JudgedDiagnosis& whole);

// Where so few movements differ from one another by more than the noise of their rows, and nothing
// says why: a cause that acts on whole movements, as one of the speed does where each is at its own
// constant speed, cannot be told from offsets that just are there.
void doubt_few_movements(JudgedDiagnosis& whole, std::size_t movements);

// Where a smooth function of the same inputs, fitted to the same movements, leaves less error on
// those that it never saw (more than rounding: then there is nothing to be tested either), or an
// effect that too few movements carry for its test. On data without a cause they leave none less:
// no correction at all is one of a smooth function's choices. needed: what to record of what was
// found and not named. The errors are known.
void doubt_nothing_missing(JudgedDiagnosis& whole, std::vector<std::string> needed);

}  // namespace tribench::loop
