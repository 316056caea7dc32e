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

enum class EarlierMovements : bool { forgotten, remembered };

// Fewer for its rate, which turns wherever the joint starts or rests.
inline constexpr double kWarmingSeconds = 10;

// How fast the temperature changes at each row [unit/s]: the slope of the straight line through the
// rows within half of kWarmingSeconds. A movement tells little through a sensor's steps: rows of
// earlier ones can count too, as far back as time runs on. Rows of later ones never do: what is
// recorded next changes nothing. 0 where there is one instant alone or a movement's time runs back.
std::vector<double> temperature_rate(std::span<const double> values, std::span<const double> time,
                                     std::span<const int> movement, EarlierMovements earlier);

}  // namespace tribench::loop
