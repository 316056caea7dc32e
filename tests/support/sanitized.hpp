// SPDX-License-Identifier: MIT
//
// What is measured of a sanitizer's build is not the program's: shadow memory is several times its
// own, and instructions cost several times as much.
#pragma once

namespace tribench::testing {

#ifdef TRIBENCH_SANITIZED
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

inline constexpr const char* kNothingToMeasure = "of a sanitizer's build nothing is measured";

}  // namespace tribench::testing
