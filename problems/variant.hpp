// SPDX-License-Identifier: MIT
//
// A problem made harder: NAME~noise=0.1~rows=50 is problem NAME with noise added to its training
// target (a share of that target's standard deviation) and so many of its training rows. What a
// sweep of a grid makes of its problems; the test rows and the law stay as they are.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "problems/problem.hpp"

namespace tribench {

// "nguyen/1~noise=0.1" -> "nguyen/1", "~noise=0.1"; the second is empty where there is none.
std::pair<std::string, std::string> split_variant(std::string_view name);

// "~noise=0.1"; both keys that there are.
std::string variant_suffix(std::string_view key, double value);
inline constexpr std::string_view kNoiseKey = "noise";
inline constexpr std::string_view kRowsKey = "rows";

// Throws Error (bad_input) for a suffix that says nothing; an empty one is none.
void check_variant(const std::string& suffix);

// The entry under the whole name. Throws Error (bad_input) for a suffix that says nothing, and,
// when it is made, where the problem has not as many rows. Noise and rows are drawn with the
// problem's seed, the same for every method.
ProblemEntry varied(const ProblemEntry& base, const std::string& suffix);

}  // namespace tribench
