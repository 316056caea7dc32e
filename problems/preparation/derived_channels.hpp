// SPDX-License-Identifier: MIT
//
// Channels that no sensor gives and that follow from a movement's history. How such a channel is
// computed stands here, once for the loop and once, beside it, as C for a controller; a test holds
// the two to the same bits.
//
//   d   distance since the last reversal, in the position's unit (or the velocity's times s).
//       0 in a movement's first row. At the first row after a change of the velocity's sign it is
//       the path from the zero crossing, the velocity taken to be linear in time:
//       |v| dt/2 * |v|/(|v| + |v_before|); else it grows by |q - q_before|, or |v| dt.
//
// Nothing here throws; a value that is not finite makes the distance so until the next reversal.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tribench::loop {

// What the path is measured by.
enum class PathFrom { position, velocity };

// One movement, row by row.
class DistanceSinceReversal {
 public:
  explicit DistanceSinceReversal(PathFrom from) : from_(from) {}
  void start_movement() { started_ = false; }
  // v, q: of this row (q is not looked at where the path comes from the velocity); dt: s since the
  // row before.
  double next(double v, double q, double dt);

 private:
  PathFrom from_;
  bool started_ = false;
  double direction_ = 0;
  double v_ = 0;
  double q_ = 0;
  double distance_ = 0;
};

// The channel's name where it was computed before the recording was cut, and not by `observe`.
inline constexpr std::string_view kDerivedDistance = "distance_since_reversal (derived)";

// "d = ..." in words, for reports.
std::string distance_recipe();

// C around a function `function`(arguments...) of which one argument is d: the state
// <function>_history, <function>_start(), which begins a movement, and <function>_step(), which
// takes the other arguments, v (and q) and dt, keeps d up to date and returns the function's value.
std::string c_history_code(std::string_view function, std::span<const std::string> arguments,
                           PathFrom from);

}  // namespace tribench::loop
