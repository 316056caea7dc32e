// SPDX-License-Identifier: MIT
//
// What of a thermometer's readings is temperature: a joint warms up within minutes, its noise and
// its steps (a tenth of a degree, often a whole one) change from row to row. In the coordinates of
// autocorrelated noise, which weigh what changes fast, they would be most of the column.
// Not for a temperature that is told once a movement: that stays as it is.
#pragma once

#include <span>
#include <vector>

namespace tribench::loop {

// Over so many seconds a temperature is a straight line.
inline constexpr double kThermalSeconds = 20;

// Each row's value of the straight line, by least squares, through its movement's rows within half
// of kThermalSeconds of it. Values in any unit, times in s; rows of one movement stand together. A
// movement whose time runs back somewhere keeps its readings. Linear in the rows.
std::vector<double> slow_temperature(std::span<const double> values, std::span<const double> time,
                                     std::span<const int> movement);

}  // namespace tribench::loop
