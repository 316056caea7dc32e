// SPDX-License-Identifier: MIT
//
// Numbers for people: few digits, no exponent where it can be helped. Files for machines keep
// every digit (csv.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tribench {

// `digits` significant digits: 0.0371, 12.3, 1.2e-07; "-" for a missing figure, "inf" for infinity.
std::string figure(double value, int digits = 3);
// As it is, with all its digits: a median of counts (22, 22.5), a published figure (1.025).
std::string count_figure(double count);
// "1 cell", "2 cells".
std::string counted(std::size_t count, std::string_view noun);
// A factor: 1.05, 3.2, 47, 1200.
std::string ratio_figure(double ratio);
// Seconds as "0.21 s", "3.4 min", "2.1 h".
std::string duration_figure(double seconds);

}  // namespace tribench
