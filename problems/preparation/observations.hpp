// SPDX-License-Identifier: MIT
//
// What the loop looks at: the channels of a data set under the short names in which effects are
// written, with those that follow from others (signs, distance since reversal, campaign time)
// computed here and nowhere else.
//
//   v sgn_v  velocity and its sign        T       temperature (slow_temperature.hpp)
//   a        acceleration                 t       time through the campaign
//   q        position                     v2 a2   the other joint's velocity and acceleration
//   g sgn_g  gravity torque and its sign  d       distance since the last reversal
//   d_seen   d, but far where a movement starts in motion: it has turned before the recording began
//   v_lag30 v_lag42 ... v_lag120          velocity as it was so many ms before
//   sgn_v_lag20 sgn_v_lag40 sgn_v_lag80   its sign through a filter of so many ms
//
// NaN policy: rows in which a used channel or the target is not finite are dropped and counted in
// the warnings. Bad input that no one can mend silently is an Error (bad_input).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/preparation/derived_channels.hpp"

// The room's words are common ones (Atom, Noise, Search): they have a namespace of their own.
namespace tribench::loop {

struct Signal {
  std::string name;     // as in formulas: "v", "sgn_v", "d", or the channel's own name
  std::string channel;  // the column it comes from
  std::string unit;
  Role role = Role::none;
  std::string recipe;  // how it is computed where it is no column of the data, else empty
  std::vector<double> values;
  std::string formula = {};  // over q, where that says it: "sin(q)"
  // A velocity of before or its sign, a distance read otherwise: nothing to look at beside the
  // signal itself.
  bool is_variant() const { return is_late() || name == kSeenDistance; }
  bool is_late() const { return LateChannel::of(name).has_value(); }
  // Seconds since a movement began: what a joint does differently after a rest.
  static constexpr std::string_view kSinceStart = "t_start";
  // It follows from the motion before (a distance since reversal, a late velocity).
  bool has_memory() const { return name == "d" || is_variant(); }
};

// A signal in which no effect can be tested, and why: "there is one movement".
struct WithheldSignal {
  std::string name;
  std::string why;
};

// Rows of one movement stand together, in the order of the campaign.
struct Observations {
  std::vector<Signal> signals;
  // Columns that nobody gave a role and that vary: no effect is written in them.
  std::vector<Signal> unused;
  std::vector<double> target;  // friction, positive with velocity
  std::string target_name;
  std::string target_unit;
  std::vector<int> movement;                // per row: index into movement_names
  std::vector<std::string> movement_names;  // all of the data set's, used or not
  // Per movement: those with one number are left out together when the models are judged (one
  // trajectory at several gains says little of the others). Empty: each movement by itself.
  std::vector<int> group;
  std::string group_name;
  std::vector<double> time;  // per row, within the campaign or the row's number
  // Per row: its number within its movement as it was recorded, before any row was left out. Empty:
  // no row was.
  std::vector<std::size_t> place;
  std::vector<std::string> rigid;  // signals whose coefficient is fitted with the base (see below)
  std::vector<WithheldSignal> withheld;  // of those in `signals`, or taken from them
  // Rows in which the motion changes faster than could be told are not here: most turns and starts.
  bool turns_left_out = false;
  std::vector<std::string> warnings;

  std::size_t rows() const { return target.size(); }
  const Signal* find(std::string_view name) const;
  std::vector<std::string> names() const;
  // Takes a signal away (if it is there) and remembers why.
  void take_away(std::string_view name, std::string why);
  // The rows for which keep[row] != 0.
  Observations select(const std::vector<char>& keep) const;
  // Every 2nd, 4th, 8th ... recorded row of each movement, so that at most about `rows` are left.
  // Powers of two of the recording's own clock: the same motion recorded at half the rate gives the
  // same rows.
  Observations thinned(std::size_t rows) const;
  // Means over neighbouring rows of a fast recording, about `rows` of them. No mean reaches over a
  // reversal, over more of the path than a gear's ripple leaves (kBlockAngle, kBlockLength) or over
  // a change of speed; where that leaves too many, means in between are left out.
  struct Shortened averaged(std::size_t rows) const;
  // The numbers of the movements that occur, in order.
  std::vector<int> movements() const;
  // Of a movement; its number where movements have no names.
  std::string name_of(int number) const;
};

struct Shortened {
  Observations data;
  double rows_each = 1;      // rows of a mean
  std::string left_between;  // ", every 3rd mean", or empty
};

// A mean over this much of the path keeps 97 % of a ripple of 320 waves a radian.
inline constexpr double kBlockAngle = 2e-3;   // rad
inline constexpr double kBlockLength = 2e-4;  // m: a twelfth of the least usual lead of a screw
inline constexpr double kBlockSpeed = 0.02;   // of the top speed

struct ObservationOptions {
  // Channels, beside those found, whose coefficients are fitted with the base and are no effects:
  // the rigid-body part that has not been subtracted.
  std::vector<std::string> rigid = {};
  // Rows slower than this (in the velocity's unit) are left out: the direction of friction at
  // standstill is not known, and a filtered velocity says little there. Without it the speed is
  // found from stretches at rest (drop_rows_at_rest); 0 keeps every row.
  std::optional<double> min_speed = {};
  // The order of the movements is not that of the campaign: nothing is said about drift.
  bool unordered = false;
  // Every movement holds one speed: it is averaged to kRowsOfSteadyMovement rows. What the measured
  // velocity does within such a movement is the controller's and the encoder's doing; row by row
  // it would pass for friction (errors in variables) and bend the fit at low speed.
  bool steady = false;
};

// The fewest that still tell noise within a movement from noise between movements.
inline constexpr std::size_t kRowsOfSteadyMovement = 5;

// From a data set with roles. The target is friction_torque, or motor_torque (motor_current)
// minus gravity_torque where the units agree. Where gravity has another unit than the target its
// column becomes `rigid`, and so does the acceleration where a motor torque comes without gravity.
// Throws Error (bad_input): no velocity, no target, friction against velocity, no usable rows.
Observations observe(const Dataset& data, const ObservationOptions& options = {});

// All names that signals have where no column keeps its own: what an effect may be written in.
std::vector<std::string> known_signal_names();

// A role's short name in formulas ("v"), or the channel's own, with _ where that is a role's name.
std::string signal_name(Role role, std::string_view channel);

// What every observation has, from whatever it was made: rows that are not finite are dropped and
// the signs of velocity and load are added. Throws Error (bad_input) where no row is left.
void complete_signals(Observations& data);

}  // namespace tribench::loop
