// SPDX-License-Identifier: MIT
//
// What an effect that comes from outside must satisfy beyond the form of its file: it is written in
// signals that there are, its shapes mean something on all of their grids, and every name that it
// refers to is there. An effect that fails here would be tested, found nowhere, and nobody would
// know why.
#pragma once

#include <string>

#include "algorithms/effects/effect_library.hpp"

namespace tribench::loop {

// Throw Error (bad_input) at `place` that names the value and the mend.
void check_atom(const AtomTemplate& atom, const std::string& place);
// The family with all its atoms, each of which has been checked.
void check_family(const EffectFamily& family, const std::string& place);

}  // namespace tribench::loop
