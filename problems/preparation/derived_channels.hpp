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
//   v_lag30 ...  the velocity as it was 30 ms before (and so on), straight between the rows; the
//       velocity of a movement's first row until then, if it does not follow on from another. What
//       friction that follows its velocity late is a function of (the pure time lag of Hess and
//       Soom 1990).
//   sgn_v_lag20 ...  the velocity's sign through a first-order filter of 20 ms (and so on), from
//       the sign in a movement's first row. What friction is that settles on its value so late.
//
// Nothing here throws; a value that is not finite makes the distance so until the next reversal.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
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

// The same, but as far as any where a movement starts in motion, or where it goes on the way that
// the one before it ended: what is bent there may stay so over a rest. Any other movement that
// starts from standstill has the one in the other.
inline constexpr std::string_view kSeenDistance = "d_seen";

// What a signal that is computed before a recording is cut is called among its channels; `observe`
// takes it as it is.
std::string derived_channel_name(std::string_view signal);

struct DerivedSignal {
  std::string signal;
  std::string recipe;
};
// Of such a name; empty for any other.
std::optional<DerivedSignal> derived_signal(std::string_view channel);

// Slower than this share of its top speed a movement stands still.
inline constexpr double kStandstill = 0.05;

// Whether a movement that begins with these two velocities starts from rest: at rest, or it was one
// row earlier, as it accelerates: rows far apart miss the rest itself. standstill: a speed.
bool starts_from_rest(double first, double second, double standstill);

// A quantity as it was a fixed time before, one movement row by row; straight between the rows. At
// most kSlots rows are remembered: of faster ones those a thirty-second of the time apart.
class TimeLag {
 public:
  explicit TimeLag(double lag_s) : lag_s_(lag_s) {}
  void start_movement() { count_ = 0; }
  // dt_s: since the row before; not looked at in the first row.
  double next(double x, double dt_s);

 private:
  struct Row {
    double time = 0;  // s since the movement began
    double x = 0;
  };
  static constexpr std::size_t kSlots = 40;
  Row& oldest(std::size_t after = 0) { return rows_[(first_ + after) % kSlots]; }

  double lag_s_;
  double now_ = 0;
  std::array<Row, kSlots> rows_ = {};  // a ring
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

// The sign of a velocity through a first-order filter, exact for a sign that holds between rows.
class SettlingSign {
 public:
  explicit SettlingSign(double time_constant_s) : time_constant_s_(time_constant_s) {}
  void start_movement() { is_started_ = false; }
  // dt_s: since the row before; not looked at in the first row.
  double next(double v, double dt_s);

 private:
  double time_constant_s_;
  bool is_started_ = false;
  double value_ = 0;
};

// A factor of the square root of two apart: friction that is late by what lies between differs from
// the nearest in a fifth of the lag at most. From what a drive's current loop and filters take to
// what lubricant does. Two apart, a late friction was taken for two effects.
inline constexpr std::array<int, 5> kLags_ms = {30, 42, 60, 85, 120};
// Two apart: a filter between two is their sum but for 3 %.
inline constexpr std::array<int, 3> kSettling_ms = {20, 40, 80};

// Whether movements that stand one after the other came so.
enum class MovementOrder { told, unknown };

// What late friction is a function of: v_lag30 ..., sgn_v_lag20 ...
class LateChannel {
 public:
  static LateChannel velocity(int lag_ms) { return {lag_ms, false}; }
  static LateChannel sign(int time_constant_ms) { return {time_constant_ms, true}; }
  static std::vector<LateChannel> all();
  // Of such a name, with any whole number of ms; empty for any other.
  static std::optional<LateChannel> of(std::string_view name);

  std::string name() const;
  std::string recipe() const;
  std::string unit(const std::string& velocity_unit) const;
  // time in s; starts anew with every movement but one that goes on where the one before it ended,
  // as strokes of one motion do: their late friction is where they begin. A clock tells the time
  // between rows no better than 10 us: a file whose time counts from 1970 gives the same values as
  // one that counts from 0.
  std::vector<double> values(std::span<const double> v, std::span<const double> time,
                             std::span<const int> movement, MovementOrder order) const;
  // Row by row: its start_movement() and next(v, dt_s).
  std::variant<TimeLag, SettlingSign> memory() const;

 private:
  LateChannel(int late_ms, bool settles) : late_ms_(late_ms), settles_(settles) {}

  int late_ms_;
  bool settles_;
};

bool is_distance(std::string_view name);  // d or d_seen
std::string seen_distance_recipe();
// d_seen from d and, per row, whether the reversal that d counts from is seen. Empty where all are,
// or none: then it says nothing that d does not.
std::vector<double> seen_distance(std::vector<double> distance, std::span<const char> seen);
// "d = ..." in words, for reports.
std::string distance_recipe();

// C around a function `function`(arguments...) of which one argument is d or d_seen: the state
// <function>_history, <function>_start(), which begins a movement, and <function>_step(), which
// takes the other arguments, v (and q) and dt, keeps d up to date and returns the function's value.
std::string c_history_code(std::string_view function, std::span<const std::string> arguments,
                           PathFrom from);

}  // namespace tribench::loop
