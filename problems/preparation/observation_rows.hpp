// SPDX-License-Identifier: MIT
//
// Which rows and signals of a recording take part in a diagnosis. Each function changes the
// observations and says what it did in their warnings. Internal to the room.
#pragma once

#include "problems/preparation/observations.hpp"

namespace tribench::loop {

// Rows with a value that is not finite.
void drop_rows_not_finite(Observations& data);

// Rows slower than min_speed, in the velocity's unit. Throws Error (bad_input) where none is left.
void drop_slow_rows(Observations& data, double min_speed);

// Rows that say as little of the direction of friction as those at rest: an axis that holds still
// lets its measured velocity change sign over and over without getting anywhere (a hundredth of the
// top speed). Where that is a twentieth of the rows or more, rows slower than they are (99 %
// quantile) are left out, and the speed and the share are said. A reversal on the way is none of
// these.
void drop_rows_at_rest(Observations& data);

// A handful of rows the other way (noise around standstill) fixes no branch of its own: Coulomb and
// viscous friction there would be fitted to next to nothing. Leaves rows of one direction then.
void settle_directions(Observations& data);

// Means of equal parts of each movement, in the order of the rows. Throws Error (bad_input) where a
// movement holds no one direction.
Observations steady_means(const Observations& data);

// Signals that never change, but v and its sign.
void drop_constant_signals(Observations& data);

// Losses are at most the load itself. A load below what this many rows can show of anything (the
// standard error of their mean) takes no part; its shape would only stand for something else.
void drop_negligible_load(Observations& data);

// Throws Error (bad_input) where every row has the same target: a dead channel shows no friction.
void check_varying(const Observations& data);

// Throws Error (bad_input) where the velocity is the same in every row and cannot be: 0, or against
// what the position does.
void check_moving(const Observations& data);

// Throws Error (bad_input) where friction opposes the velocity.
void check_sign(const Observations& data, bool torques_flipped);

}  // namespace tribench::loop
