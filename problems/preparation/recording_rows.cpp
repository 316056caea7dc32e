// SPDX-License-Identifier: MIT
#include "problems/preparation/recording_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/order_statistics.hpp"
#include "problems/preparation/segments.hpp"
#include "problems/table.hpp"

namespace tribench {

Channel* find_channel(Dataset& data, Role role) {
  const auto found = std::ranges::find(data.channels, role, &Channel::role);
  return found == data.channels.end() ? nullptr : &*found;
}

void keep_rows(Dataset& data, const std::vector<std::size_t>& rows) {
  if (rows.size() < data.rows()) data = select_rows({data, {}}, rows).data;
}

namespace {

// How far the position jumps where it starts again; 0: it does not. Without a gap in time, and a
// turn or the same jump over and over: a lost message is neither.
double turn_of(const Channel& q, const Channel* t, const Dataset& data) {
  const double gap = t != nullptr ? 5 * median_step(t->values, data.movement) : 0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < data.rows(); ++i) {
    const bool follows = data.movement[i] == data.movement[i - 1] &&
                         (gap <= 0 || t->values[i] - t->values[i - 1] <= gap);
    if (follows) steps.push_back(std::abs(q.values[i] - q.values[i - 1]));
  }
  if (steps.size() < 10) return 0;
  const double largest = *std::ranges::max_element(steps);
  const double usual = quantile(steps, 0.99);
  if (usual <= 0 || largest < 20 * usual) return 0;
  if (std::abs(largest - kRadPerTurn) < 0.1 * kRadPerTurn) return kRadPerTurn;
  const auto alike = std::ranges::count_if(
      steps, [&](double step) { return std::abs(step - largest) < 2 * usual; });
  return alike >= 3 ? largest : 0;
}

}  // namespace

// An angle that starts again after a turn is laid end to end.
void unwrap(PreparedRecording& out) {
  Channel* q = find_channel(out.data, Role::position);
  if (q == nullptr || q->unit != "rad") return;
  const double turn = turn_of(*q, find_channel(out.data, Role::time), out.data);
  if (turn <= 0) return;
  std::size_t wraps = 0;
  double offset = 0;
  for (std::size_t i = 1; i < out.data.rows(); ++i) {
    const double before = q->values[i - 1] - offset;  // as it was in the file
    const double step = q->values[i] - before;
    if (out.data.movement[i] != out.data.movement[i - 1]) {
      offset = 0;
    } else if (std::abs(std::abs(step) - turn) < 0.2 * turn) {
      offset -= std::copysign(turn, step);
      ++wraps;
    }
    q->values[i] += offset;
  }
  out.notes.push_back(fmt::format("'{}' starts again {} times after {:.4g} rad: laid end to end",
                                  q->name, wraps, turn));
}

void leave_out(PreparedRecording& out, const std::vector<char>& rows, const std::string& why) {
  const auto count = std::ranges::count(rows, 1);
  if (count == 0) return;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] == 0) kept.push_back(i);
  }
  out.notes.push_back(fmt::format("{} of {} rows {}: left out", count, rows.size(), why));
  keep_rows(out.data, kept);
}

// Stamps that do not move on: the later row of two is left out.
void drop_repeated_stamps(PreparedRecording& out) {
  const Channel* t = find_channel(out.data, Role::time);
  if (t == nullptr) return;
  std::vector<char> repeated(out.data.rows(), 0);
  for (std::size_t i = 1; i < out.data.rows(); ++i) {
    repeated[i] =
        out.data.movement[i] == out.data.movement[i - 1] && t->values[i] <= t->values[i - 1] ? 1
                                                                                             : 0;
  }
  if (2 * static_cast<std::size_t>(std::ranges::count(repeated, 1)) > out.data.rows()) return;
  leave_out(out, repeated, "repeat the time of the row before");
}

void drop_repeated_messages(PreparedRecording& out) {
  const Channel* q = find_channel(out.data, Role::position);
  const Channel* noisy = find_channel(out.data, Role::motor_torque);
  if (noisy == nullptr) noisy = find_channel(out.data, Role::motor_current);
  if (q == nullptr || noisy == nullptr) return;
  leave_out(out, repeated_rows(q->values, noisy->values),
            "repeat the row before in position and torque, as a bus does that lost its messages");
}

void drop_clipped(PreparedRecording& out) {
  for (const Role role : {Role::motor_torque, Role::motor_current}) {
    const Channel* torque = find_channel(out.data, role);
    if (torque == nullptr) continue;
    leave_out(out, clipped_rows(torque->values),
              fmt::format("have '{}' at its limit", torque->name));
  }
}

}  // namespace tribench
