// SPDX-License-Identifier: MIT
//
// Friction models with memory as methods: `dahl`, `lugre`, `maxwell_slip` (generalised Maxwell slip
// of four elements). The few parameters that the force is not linear in are searched for from a
// grid of starts, the rest is solved exactly (fitting/separable_fit): no seed, no random number.
//
// They need an input with role velocity and rows in time (a channel with role time); elsewhere they
// say what is missing. Rows whose state still shows how it started (more than a twentieth) are left
// out of a second fit, since that start is not known. Sources: algorithms/states/README.md.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry dahl_entry();
AlgorithmEntry lugre_entry();
AlgorithmEntry maxwell_slip_entry();

}  // namespace tribench
