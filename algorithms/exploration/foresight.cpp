// SPDX-License-Identifier: MIT
#include "algorithms/exploration/foresight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "foundation/elementary.hpp"
#include "problems/joint_simulation/joint_recording.hpp"
#include "problems/joint_simulation/world_motion.hpp"

namespace tribench::loop {
namespace {

constexpr std::array kSpeeds = {0.04, 0.08, 0.16, 0.32, 0.6, 1.0};  // of the limit
constexpr double kNarrow = 0.0625;                                  // of the range, to either side
constexpr double kUsualCooling_s = 60;
constexpr double kUsualWarmth = 0.5;  // of the rise that is allowed

void keep_if_allowed(std::vector<PlannedMovement>& all, PlannedMovement movement,
                     const MotionLimits& limits, double longest_s) {
  const double seconds = seconds_of(movement, start_of(movement), limits);
  if (seconds > longest_s || seconds < 2 / limits.rate_hz) return;
  if (broken_limit(movement, limits).broken()) return;
  all.push_back(std::move(movement));
}

std::vector<double> load_factors(const MotionLimits& limits) {
  std::vector<double> factors = {1};
  if (limits.gravity_nm == 0) return factors;
  for (const double factor : {limits.greatest_load_factor, limits.least_load_factor}) {
    if (std::ranges::count(factors, factor) == 0) factors.push_back(factor);
  }
  return factors;
}

struct Layout {
  double begin_s;
  double temperature_degc;  // when it begins
  double warming_k_s = 0;
};

// The rows of each movement from its own begin on.
template <typename LayoutOf>
Dataset rows_of(std::span<const PlannedMovement> movements, const Dataset& like,
                const MotionLimits& limits, double rate_hz, LayoutOf layout_of) {
  Dataset out;
  out.name = "foreseen";
  for (const Channel& channel : like.channels) {
    out.channels.push_back({channel.name, channel.unit, channel.role, {}});
  }
  for (std::size_t m = 0; m < movements.size(); ++m) {
    out.movement_names.push_back(std::to_string(m + 1));
    const simulation::Movement motion = simulation::motion_for(movements[m], limits);
    const Layout layout = layout_of(m);
    // At instants at which rows are recorded too: slow ones between them tell nothing.
    const auto steps = static_cast<std::size_t>(motion.duration_s() * rate_hz);
    for (std::size_t i = 0; i <= steps; ++i) {
      const double t_s = static_cast<double>(i) / rate_hz;
      const simulation::Instant now = simulation::instant_of(motion, t_s);
      if (now.sign() == 0) continue;
      for (Channel& channel : out.channels) {
        double value = 0;
        switch (channel.role) {
          case Role::time:
            value = layout.begin_s + t_s;
            break;
          case Role::position:
            value = now.joint.position_rad;
            break;
          case Role::velocity:
            value = now.joint.velocity_rad_s;
            break;
          case Role::acceleration:
            value = now.joint.acceleration_rad_s2;
            break;
          case Role::gravity_torque:
            value = now.gravity_nm;
            break;
          case Role::temperature:
            value = layout.temperature_degc + layout.warming_k_s * t_s;
            break;
          case Role::other_velocity:
            value = now.other.velocity_rad_s;
            break;
          case Role::other_acceleration:
            value = now.other.acceleration_rad_s2;
            break;
          case Role::friction_torque:
          case Role::motor_torque:
            value = now.sign();  // never looked at but for its sign
            break;
          default:
            break;
        }
        channel.values.push_back(value);
      }
      out.movement.push_back(static_cast<int>(m));
    }
  }
  return out;
}

}  // namespace

std::vector<PlannedMovement> candidate_movements(const MotionLimits& limits, double longest_s) {
  const double low = limits.lowest_rad;
  const double high = limits.highest_rad;
  const double centre = 0.5 * (low + high);
  const double narrow = kNarrow * (high - low);
  std::vector<PlannedMovement> all;
  const auto add = [&](PlannedMovement movement, double rest_s, double other_rad_s) {
    movement.rest = rest_s;
    movement.other_velocity = other_rad_s;
    keep_if_allowed(all, std::move(movement), limits, longest_s);
  };
  const double other = limits.greatest_other_velocity_rad_s;
  for (const double part : kSpeeds) {
    const double speed = part * limits.speed_rad_s;
    for (const double factor : load_factors(limits)) {
      for (const double direction : {1.0, -1.0}) {
        add(constant_movement(direction * speed, low, high, factor), 0, 0);
        if (other > 0) add(constant_movement(direction * speed, low, high, factor), 0, other);
        add(constant_movement(direction * speed, low, centre, factor), 0, 0);
        add(constant_movement(direction * speed, centre, high, factor), 0, 0);
        add(constant_movement(direction * speed, centre - narrow, centre + narrow, factor), 0, 0);
      }
      for (const double reach : {8.0, 3.0, 1.0}) {
        PlannedMovement tones =
            two_tone_movement(speed, centre - reach * narrow, centre + reach * narrow, factor);
        add(tones, 0, 0);
        if (other > 0) add(tones, 0, other);
        tones.duration /= 3;
        add(tones, 0, 0);
        if (other > 0) add(tones, 0, other);
      }
    }
    for (const double direction : {1.0, -1.0}) {
      add(constant_movement(direction * speed, low, high, 1), limits.longest_rest_s, 0);
      add(constant_movement(direction * speed, centre - narrow, centre + narrow, 1),
          limits.longest_rest_s, 0);
    }
    PlannedMovement tones = two_tone_movement(speed, centre - 3 * narrow, centre + 3 * narrow, 1);
    add(tones, limits.longest_rest_s, 0);
    tones.duration /= 3;
    add(tones, limits.longest_rest_s, 0);
  }
  return all;
}

Dataset foreseen_rows(std::span<const PlannedMovement> movements, const Dataset& like,
                      const MotionLimits& limits, const JointNow& now, double rate_hz) {
  const double ambient = limits.ambient_degc;
  const double warm = now.temperature_degc.value_or(ambient);
  return rows_of(movements, like, limits, rate_hz, [&](std::size_t m) {
    const double cooled = elementary::exp(-movements[m].rest / kUsualCooling_s);
    return Layout{now.time_s + movements[m].rest, ambient + (warm - ambient) * cooled};
  });
}

Dataset reference_rows(std::span<const PlannedMovement> movements, const Dataset& like,
                       const MotionLimits& limits, double rate_hz) {
  const auto count = static_cast<double>(movements.size());
  return rows_of(movements, like, limits, rate_hz, [&](std::size_t m) {
    const double part = (static_cast<double>(m) + 0.5) / count;
    // Warmth, and how it changes, in other orders than time (low-discrepancy sequences).
    const auto number = static_cast<double>(m);
    const double warmth = std::fmod(0.5 + 0.6180339887498949 * number, 1.0);
    const double warming = 2 * std::fmod(0.5 + 0.4142135623730951 * number, 1.0) - 1;
    const double usual_k = kUsualWarmth * limits.temperature_rise_k;
    return Layout{part * limits.seconds, limits.ambient_degc + usual_k * warmth,
                  usual_k * warming / kUsualCooling_s};
  });
}

void add_warming(Observations& rows, EarlierMovements earlier) {
  const Signal* sensor = rows.find("T");
  if (sensor == nullptr) return;
  Signal warming{std::string(kWarming), "", "K/s", Role::none, "slope of T", {}};
  warming.values = temperature_rate(sensor->values, rows.time, rows.movement, earlier);
  rows.signals.push_back(std::move(warming));
}

Observations observe_plan(const Dataset& rows) {
  ObservationOptions every_row;
  every_row.min_speed = 0;
  Observations out = observe(rows, every_row);
  out.take_away(kSeenDistance, "movements that are asked for start from rest");
  const Channel* time = rows.find(Role::time);
  if (time == nullptr || out.rows() != rows.rows()) return out;
  for (Signal& signal : out.signals) {
    if (signal.name == "t") signal.values = time->values;
  }
  out.time = time->values;
  add_warming(out, EarlierMovements::forgotten);
  return out;
}

Observations with_signals_of(const Observations& model, const Observations& data,
                             const Dataset& channels) {
  Observations out = data;
  out.signals.clear();
  for (const Signal& wanted : model.signals) {
    if (const Signal* found = data.find(wanted.name)) {
      out.signals.push_back(*found);
      continue;
    }
    Signal constant{wanted.name, wanted.channel, wanted.unit, wanted.role, wanted.recipe, {}};
    const Channel* channel = channels.find(wanted.channel);
    const bool known = channel != nullptr && !channel->values.empty() && !wanted.has_memory();
    constant.values.assign(data.rows(), known ? channel->values.front() : 0);
    out.signals.push_back(std::move(constant));
  }
  return out;
}

}  // namespace tribench::loop
