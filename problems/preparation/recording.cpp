// SPDX-License-Identifier: MIT
#include "problems/preparation/recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "foundation/error.hpp"
#include "problems/preparation/motion_check.hpp"
#include "problems/preparation/rigid_body.hpp"
#include "problems/reading/explanation.hpp"

#include "problems/preparation/recording_steps.hpp"

namespace tribench {
namespace {

// A velocity is enough to go on, but without a position nothing is known of gravity: one may stand
// in the file under a name that says nothing.
void note_no_position(PreparedRecording& out, const DataFile& file) {
  if (file.data.find(Role::position) != nullptr) return;
  std::vector<std::string> strangers;
  for (const ColumnReading& reading : file.readings) {
    const bool known = reading.role != Role::none || !reading.remark.empty();
    if (!known) strangers.push_back(fmt::format("'{}'", reading.column));
  }
  if (strangers.empty()) return;
  constexpr std::size_t kShown = 12;
  const bool more = strangers.size() > kShown;
  if (more) strangers.resize(kShown);
  out.notes.push_back(fmt::format(
      "no column is the position, so gravity and ripples cannot be told; not understood: {}{} "
      "(--roles COLUMN=position[UNIT])",
      fmt::join(strangers, ", "), more ? ", ..." : ""));
}

// Nor are accelerations, delays and gaps told without a time: it may stand there unknown too.
void note_no_time(PreparedRecording& out) {
  const bool told = out.data.find(Role::time) != nullptr ||
                    out.data.find(Role::acceleration) != nullptr ||
                    out.data.find(Role::position) == nullptr;
  if (told) return;
  out.notes.emplace_back(
      "no column is the time: the velocity is taken as it stands, and there is no acceleration "
      "(--roles COLUMN=time[UNIT] or, where the rows are even, --sample-rate HZ)");
}

}  // namespace

PreparedRecording prepare(DataFile file, const DataOptions& options, Gravity gravity,
                          SlowRows slow) {
  check_complete(file);
  PreparedRecording out;
  out.notes = file.warnings;
  if (file.dropped_rows > 0) {
    out.notes.push_back(fmt::format("{} rows with missing values dropped", file.dropped_rows));
  }
  for (std::string& one : what_was_converted(file)) out.notes.push_back(std::move(one));
  note_no_position(out, file);
  out.data = std::move(file.data);
  note_no_time(out);
  sort_movements(out);
  if (std::string made = make_torque(out.data, options); !made.empty()) {
    out.notes.push_back(std::move(made));
  }
  check_units(out);
  spread_coarse_stamps(out);
  drop_repeated_stamps(out);
  drop_repeated_messages(out);
  drop_stuck_efforts(out);
  unwrap(out, file.readings, options.drive);
  if (!file.has_movements) {
    drop_wrong_readings(out);
    settle_jumps(out);
    settle_clock(out);
  }
  file.data = std::move(out.data);
  check_motion(file, options.drive.gear_ratio);
  if (std::optional<std::string> one = remark_on_turns(file)) out.notes.push_back(std::move(*one));
  out.data = std::move(file.data);
  settle_other_acceleration(out);
  double noise = 0;
  double acceleration_noise = 0;
  double blur = 0;
  if (const std::optional<DerivedMotion> derived = derive_motion(out)) {
    noise = derived->motion.velocity_noise;
    acceleration_noise = derived->motion.acceleration_noise;
    settle_velocity(out, *derived);
    settle_acceleration(out, *derived);
    mark_unresolved(out, *derived);
    blur = kBlur / (kRadPerTurn * derived->motion.bandwidth);
    if (out.derived_velocity) drop_edges(out, *derived);
  } else if (out.data.find(Role::velocity) == nullptr) {
    throw_bad_input(
        "there is no velocity, and the rows are too uneven or too far apart in time to "
        "derive it",
        out.data.name, "name the velocity's column: --roles COLUMN=velocity[UNIT]");
  }
  drop_clipped(out);
  if (!file.has_movements) {
    settle_effort(out, options.drive);
    add_undeclared_inertia(out);
  }
  // Several files with all of their motion are movements as somebody cut them.
  const bool raw = out.derived_velocity || out.data.find("derived_acceleration") != nullptr;
  if (!file.has_movements && (raw || out.data.movement_names.size() == 1)) {
    cut_strokes(out, noise, blur);
  } else if (slow == SlowRows::left_out) {
    settle_strokes(out, out.derived_velocity ? noise : 0);
  }
  adjust_acceleration(out);
  drop_unresolved(out);
  drop_lonely_acceleration(out);
  drop_unseen_acceleration(out, acceleration_noise);
  check_gravity_factor(out, options);
  fit_gravity(out, gravity);
  return out;
}

}  // namespace tribench
