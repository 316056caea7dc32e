// SPDX-License-Identifier: MIT
//
// The static friction model (LuGre's steady state) as an algorithm, symmetric or with a set of
// parameters for each direction:
//
//   tau(v) = sgn(v) (Fc + (Fs - Fc) exp(-|v / vs|^delta)) + Fv v   [+ M a] [+ offset]
//
// Forms: `bounded` (Fs >= Fc >= 0, 0 < vs <= max |v|, 0.5 <= delta <= 4), solved to global
// optimality; `as_printed`, the unbounded basin hopping of the paper, which degenerates as the
// paper's did; `coulomb_viscous`, without the Stribeck term. The term M a is there where the
// problem has an input with the role acceleration.
//
// Source: Scholl et al. 2025, eq. for static friction, after Canudas de Wit et al. 1995.
#pragma once

#include "algorithms/regressor.hpp"

namespace tribench {

AlgorithmEntry symmetric_entry();
AlgorithmEntry asymmetric_entry();

}  // namespace tribench
