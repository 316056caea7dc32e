// SPDX-License-Identifier: MIT
//
// The sign function of formulas and of the data's derived channels. Not for the sign bit of a
// number (std::signbit): -0.0 is as much at rest as 0.0.
#pragma once

namespace tribench {

// -1, 0 or 1; 0 of either zero, NaN of NaN.
constexpr double sign(double x) { return x > 0 ? 1.0 : (x < 0 ? -1.0 : x == 0 ? 0.0 : x); }

}  // namespace tribench
