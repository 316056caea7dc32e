// SPDX-License-Identifier: MIT
//
// The steps by which `prepare` makes a recording of a file, in its order. Each changes the
// recording and says in its notes what it did; each throws Error (bad_input) for what cannot be
// true. Internal to the room.
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "problems/preparation/motion_smoother.hpp"
#include "problems/preparation/recording.hpp"

namespace tribench {

inline constexpr std::size_t kFewestRows = 8;  // of a stroke, of a piece
inline constexpr double kBlur = 3;             // time constants of the smoother
inline constexpr double kRadPerTurn = 2 * std::numbers::pi;

Channel* find_channel(Dataset& data, Role role);  // null: there is none

// ---- rows (recording_rows.cpp)

void keep_rows(Dataset& data, const std::vector<std::size_t>& rows);
// Those that are marked, with a sentence: "12 of 900 rows WHY: left out".
void leave_out(PreparedRecording& out, const std::vector<char>& rows, const std::string& why);
// A clock that ticks more slowly than the rows come: between two gaps they are taken to be even.
void spread_coarse_stamps(PreparedRecording& out);
// Stamps that do not move on: the later row of two is left out.
void drop_repeated_stamps(PreparedRecording& out);
void drop_repeated_messages(PreparedRecording& out);
// Torques and currents that keep a value for long while the joint moves.
void drop_stuck_efforts(PreparedRecording& out);
// A position that starts again after a turn, or where its counter is full, is laid end to end.
void unwrap(PreparedRecording& out, const std::vector<ColumnReading>& readings, const Drive& drive);
// Rows whose position, velocity or torque is far off the rows before and after: wrong readings.
void drop_wrong_readings(PreparedRecording& out);
// A position that is set anew while the joint goes on (a reference mark) is laid end to end; where
// it goes on otherwise two recordings were put together, and a movement begins.
void settle_jumps(PreparedRecording& out);
// Currents and torques at a limit of the amplifier.
void drop_clipped(PreparedRecording& out);

// ---- motion (recording_motion.cpp)

// Steady instants in place of jittering stamps, where the position moves more smoothly at them.
void settle_clock(PreparedRecording& out);

struct DerivedMotion {
  Motion motion;
  Motion slower;  // of half the bandwidth
  std::vector<RowRange> pieces;
};

// Nothing where there is no position, or the rows are too uneven or too far apart in time.
std::optional<DerivedMotion> derive_motion(const PreparedRecording& out);
// The derived velocity where there is none, or one that lags behind its position, has more noise or
// coarser steps than the position leaves open; where they nearly agree the torque decides.
void settle_velocity(PreparedRecording& out, const DerivedMotion& derived);
// The derived acceleration where there is none.
void settle_acceleration(PreparedRecording& out, const DerivedMotion& derived);
// The inertia of a motor torque was not declared: it is no effect that friction lacks, and stands
// in the base, whether the acceleration was told or derived.
void add_undeclared_inertia(PreparedRecording& out);
// The other joint's acceleration from its velocity, where there is none.
void settle_other_acceleration(PreparedRecording& out);
// Where the motion changes faster than the smoother follows, what it lacks would be taken for
// friction. Marked before rows are left out, dropped when the movements are cut.
void mark_unresolved(PreparedRecording& out, const DerivedMotion& derived);
void drop_unresolved(PreparedRecording& out);
// Accelerations that a single movement holds.
void drop_lonely_acceleration(PreparedRecording& out);
// Accelerations that are little but noise; noise: of one.
void drop_unseen_acceleration(PreparedRecording& out, double noise);
// A smoother takes something off a derived acceleration that changes fast and leaves noise in one
// that does not: where between half the bandwidth and beyond the whole it is right the torque
// tells.
void adjust_acceleration(PreparedRecording& out);
// A torque or a current that comes later than its motion is put beside the motion of its instant.
void settle_effort(PreparedRecording& out, const Drive& drive);
// Rows of no piece have no derived motion, and the ends of a piece a poor one.
void drop_edges(PreparedRecording& out, const DerivedMotion& derived);

// ---- movements (recording_movements.cpp)

// Movements as they came in time, in whatever order the file has them: what is told of rows that
// follow one another is told of the same ones. As they stand where their clocks overlap.
void sort_movements(PreparedRecording& out);
// Strokes for movements. noise: of the velocity; blur: s that it is uncertain around a rest or a
// reversal.
void cut_strokes(PreparedRecording& out, double noise, double blur);
// Within movements that a column or several files name: the same rows are left out, near rests and
// reversals, and the path since the last reversal is told by the rows that stay and those that go.
void settle_strokes(PreparedRecording& out, double noise);

// ---- gravity (recording_gravity.cpp)

// Two quantities of different units are never subtracted.
void check_units(const PreparedRecording& out);
// Declared gravity that goes into the torque with a factor of -1, 1000, the gear ratio.
void check_gravity_factor(const PreparedRecording& out, const DataOptions& options);
// sin and cos of the position for gravity that no column declares.
void fit_gravity(PreparedRecording& out, Gravity gravity);

}  // namespace tribench
