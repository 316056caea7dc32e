// SPDX-License-Identifier: MIT
//
// What a movement would show before it is made: its rows as signals, and the reference campaign
// (every candidate once, spread over the seconds and the warmth that the limits allow) over which
// an effect has its size. Motion is that of the limits' ramps; nothing is said about torque.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/experiment/motion_limits.hpp"
#include "problems/experiment/planned_movement.hpp"
#include "problems/preparation/observations.hpp"
#include "problems/preparation/slow_temperature.hpp"

namespace tribench::loop {

// Where the joint stands between movements.
struct JointNow {
  double time_s = 0;
  double position_rad = 0;
  std::optional<double> temperature_degc = {};
};

// The movements from which the next one is chosen, longest first cut off at `longest_s`: constant
// speeds over the whole, half and an eighth of the range, two tones, three loads where the limits
// have them; some after a rest, some with the other joint.
std::vector<PlannedMovement> candidate_movements(const MotionLimits& limits, double longest_s);

// Every movement as rows, one movement of the dataset each; channels as `like` has them (those that
// a plan does not set stand still). Times run from now on for each of them.
Dataset foreseen_rows(std::span<const PlannedMovement> movements, const Dataset& like,
                      const MotionLimits& limits, const JointNow& now, double rate_hz);

// The same spread over limits.seconds and limits.temperature_rise_k.
Dataset reference_rows(std::span<const PlannedMovement> movements, const Dataset& like,
                       const MotionLimits& limits, double rate_hz);

// How fast the temperature changes [K/s], a further signal: what a late sensor does not know yet.
inline constexpr std::string_view kWarming = "T_rate";
// Nothing where no temperature varies.
void add_warming(Observations& rows, EarlierMovements earlier);

// Foreseen or reference rows as signals; each movement keeps its own time, wherever the one before
// it ended, and its own warming.
Observations observe_plan(const Dataset& rows);

// `data` with the signals of `model`, in its order: those that never vary in `data` are filled with
// the channel's value.
Observations with_signals_of(const Observations& model, const Observations& data,
                             const Dataset& channels);

}  // namespace tribench::loop
