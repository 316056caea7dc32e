// SPDX-License-Identifier: MIT
//
// The sign function of formulas and of the data's derived channels.
#pragma once

namespace tribench {

// -1, 0 or 1; 0 of either zero, NaN of NaN.
constexpr double sign(double x) { return x > 0 ? 1.0 : (x < 0 ? -1.0 : x == 0 ? 0.0 : x); }

}  // namespace tribench
