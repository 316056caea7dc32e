// SPDX-License-Identifier: MIT
#include "problems/preparation/recording_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "foundation/error.hpp"
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

// Steps of a channel between rows that follow one another; the step into each row.
struct Jumps {
  double largest = 0;
  double usual = 0;  // 99 % are smaller
  std::vector<double> steps;
};

// Across lost messages a position may go anywhere.
Jumps jumps_of(const Channel& q, const Channel* t, const Dataset& data) {
  const double gap = t != nullptr ? 5 * median_step(t->values, data.movement) : 0;
  Jumps jumps;
  for (std::size_t i = 1; i < data.rows(); ++i) {
    const bool follows = data.movement[i] == data.movement[i - 1] &&
                         (gap <= 0 || t->values[i] - t->values[i - 1] <= gap);
    if (follows) jumps.steps.push_back(std::abs(q.values[i] - q.values[i - 1]));
  }
  if (jumps.steps.empty()) return jumps;
  jumps.largest = *std::ranges::max_element(jumps.steps);
  jumps.usual = quantile(jumps.steps, 0.99);
  return jumps;
}

// A turn, of the side of the gear that is told, or what a counter of so many bits holds; 0: the
// values do not lie within one of those from edge to edge. count: one of the encoder's, 0 where
// only the values tell it.
double known_turn(const Channel& q, bool at_motor, const Drive& drive, double count) {
  const auto [low, high] = std::ranges::minmax(q.values);
  const double range = high - low;
  const auto fills = [&](double turn) {
    constexpr double kFilled = 0.8;
    return range > kFilled * turn && range < 1.001 * turn;
  };
  const double turn = kRadPerTurn / (at_motor && drive.gear_ratio ? *drive.gear_ratio : 1);
  if (q.unit == "rad" && fills(turn)) return turn;
  if (count <= 0) count = resolution_of(q.values);
  for (const int bits : {8, 10, 12, 13, 14, 15, 16, 17, 18, 20, 24, 31, 32}) {
    const double span = std::ldexp(count, bits);
    if (count > 0 && fills(span)) return span;
  }
  return 0;
}

// How far the position jumps where it starts again; 0: it does not. Without a gap in time, and
// across what a turn or a counter holds or by the same over and over, over all the way that it ever
// goes: a wrong reading is neither, nor is a movement that begins elsewhere than the last one
// ended.
double turn_of(const Channel& q, bool at_motor, const Drive& drive, double count,
               const Jumps& jumps) {
  if (jumps.steps.size() < 10 || jumps.usual <= 0) return 0;
  const auto [low, high] = std::ranges::minmax(q.values);
  if (jumps.largest > 0.5 * (high - low)) {
    if (const double turn = known_turn(q, at_motor, drive, count); turn > 0) return turn;
  }
  if (jumps.largest < 20 * jumps.usual) return 0;
  if (q.unit == "rad" && std::abs(jumps.largest - kRadPerTurn) < 0.1 * kRadPerTurn) {
    return kRadPerTurn;
  }
  const auto alike = std::ranges::count_if(
      jumps.steps, [&](double step) { return std::abs(step - jumps.largest) < 2 * jumps.usual; });
  const double way = quantile(q.values, 0.999) - quantile(q.values, 0.001);
  return alike >= 3 && way < jumps.largest + 2 * jumps.usual ? jumps.largest : 0;
}

}  // namespace

namespace {

// How a channel goes on: a position straight, what is noisy as it was.
enum class GoesOn { straight, level };

// Rows, five at most in a row, after which the channel goes on as before, and which are off that
// by far more than it ever moves. `when`: each row's time.
std::vector<char> wrong_readings(const std::vector<double>& x, const std::vector<double>& when,
                                 const std::vector<int>& movement, GoesOn how) {
  constexpr double kFar = 10;          // usual surprises
  constexpr std::size_t kLongest = 5;  // rows
  constexpr double kBack = 0.2;        // of the surprise
  std::vector<char> wrong(x.size(), 0);
  if (x.size() < 100) return wrong;
  // In the row i + k, for who knows the rows i - 2 and i - 1.
  const auto surprise = [&](std::size_t i, std::size_t k) {
    const double slope =
        how == GoesOn::straight ? (x[i - 1] - x[i - 2]) / (when[i - 1] - when[i - 2]) : 0;
    return std::abs(x[i + k] - x[i - 1] - slope * (when[i + k] - when[i - 1]));
  };
  std::vector<double> surprises;
  for (std::size_t i = 2; i < x.size(); ++i) surprises.push_back(surprise(i, 0));
  const double usual = quantile(surprises, 0.99);
  for (std::size_t i = 2; usual > 0 && i + 1 < x.size(); ++i) {
    if (surprises[i - 2] < kFar * usual) continue;
    for (std::size_t k = 1; k <= kLongest && i + k < x.size(); ++k) {
      if (movement[i + k] != movement[i - 2]) break;
      if (surprise(i, k) > kBack * surprises[i - 2]) continue;
      std::fill_n(wrong.begin() + static_cast<std::ptrdiff_t>(i), k, 1);
      i += k + 1;  // the row after next is the first to be told by rows that are right
      break;
    }
  }
  return wrong;
}

// Without a time the rows' numbers.
std::vector<double> when_rows_were(const Dataset& data) {
  if (const Channel* t = data.find(Role::time)) return t->values;
  std::vector<double> when(data.rows());
  std::iota(when.begin(), when.end(), 0.0);
  return when;
}

}  // namespace

void drop_wrong_readings(PreparedRecording& out) {
  for (const Role role :
       {Role::position, Role::velocity, Role::motor_torque, Role::motor_current}) {
    const Channel* channel = find_channel(out.data, role);
    if (channel == nullptr) continue;
    const GoesOn how = role == Role::position ? GoesOn::straight : GoesOn::level;
    leave_out(out,
              wrong_readings(channel->values, when_rows_were(out.data), out.data.movement, how),
              fmt::format("have a wrong reading of '{}', far off the rows before and after",
                          channel->name));
  }
}

namespace {

// Per row: by how much a channel's mean over so many rows after it differs from that before it.
std::vector<double> changes_of(const std::vector<double>& x, std::size_t rows) {
  std::vector<double> sum(x.size() + 1, 0.0);
  std::partial_sum(x.begin(), x.end(), sum.begin() + 1);
  std::vector<double> change(x.size(), 0.0);
  for (std::size_t i = rows; i + rows < x.size(); ++i) {
    const double after = sum[i + rows + 1] - sum[i + 1];
    const double before = sum[i] - sum[i - rows];
    change[i] = std::abs(after - before) / static_cast<double>(rows);
  }
  return change;
}

// Rows across which the channel goes on as it does nearly everywhere.
std::vector<char> goes_on(const std::vector<double>& x, std::size_t rows) {
  constexpr double kNearlyEverywhere = 0.95;
  const std::vector<double> change = changes_of(x, rows);
  const double usual = quantile(change, kNearlyEverywhere);
  std::vector<char> same;
  for (const double one : change) same.push_back(one <= usual ? 1 : 0);
  return same;
}

std::vector<double> speeds_of(const Channel& q, const std::vector<double>& time) {
  std::vector<double> speed(time.size(), 0.0);
  for (std::size_t i = 1; i < time.size(); ++i) {
    speed[i] = (q.values[i] - q.values[i - 1]) / (time[i] - time[i - 1]);
  }
  return speed;
}

// Rows into which the position steps farther, by far, than it does before and after.
std::vector<std::size_t> rows_after_jumps(const Channel& q, const Channel& t, const Dataset& data) {
  constexpr double kFar = 3;  // usual steps
  const Jumps steps = jumps_of(q, &t, data);
  if (steps.steps.size() < 100 || steps.usual <= 0) return {};
  const double gap = 1.5 * median_step(t.values, data.movement);
  std::vector<std::size_t> rows;
  for (std::size_t i = 2; i + 1 < data.rows(); ++i) {
    if (data.movement[i - 2] != data.movement[i + 1] || t.values[i] - t.values[i - 1] > gap) {
      continue;
    }
    const double before = q.values[i - 1] - q.values[i - 2];
    const double step = q.values[i] - q.values[i - 1];
    const double after = q.values[i + 1] - q.values[i];
    const double beyond = std::max(std::min(before, after) - step, step - std::max(before, after));
    if (beyond > kFar * steps.usual) rows.push_back(i);
  }
  return rows;
}

// Rows across which speed and torque go on: whoever sets a position anew changes neither.
std::vector<char> motion_goes_on(const Dataset& data, const std::vector<double>& speed,
                                 double step_s) {
  constexpr double kSeen_s = 0.02;  // on either side
  const auto seen = static_cast<std::size_t>(std::max(2.0, std::round(kSeen_s / step_s)));
  std::vector<char> same = goes_on(speed, seen);
  for (const Role role : {Role::motor_torque, Role::motor_current}) {
    const Channel* effort = data.find(role);
    if (effort == nullptr) continue;
    const std::vector<char> own = goes_on(effort->values, seen);
    for (std::size_t i = 0; i < same.size(); ++i) same[i] = same[i] != 0 && own[i] != 0 ? 1 : 0;
  }
  return same;
}

std::string jumps_told(const Channel& q, const std::vector<std::size_t>& rows,
                       std::string_view what) {
  double largest = 0;
  for (const std::size_t row : rows) {
    largest = std::max(largest, std::abs(q.values[row] - q.values[row - 1]));
  }
  return fmt::format("'{}' jumps {} times, by {:.4g} {} at most, and the joint {}", q.name,
                     rows.size(), largest, q.unit, what);
}

}  // namespace

void settle_jumps(PreparedRecording& out) {
  Channel* q = find_channel(out.data, Role::position);
  const Channel* t = find_channel(out.data, Role::time);
  if (q == nullptr || t == nullptr || !is_regular(t->values, out.data.movement)) return;
  const std::vector<std::size_t> jumps = rows_after_jumps(*q, *t, out.data);
  if (jumps.empty()) return;
  const std::vector<double> speed = speeds_of(*q, t->values);
  const std::vector<char> same =
      motion_goes_on(out.data, speed, median_step(t->values, out.data.movement));
  std::vector<std::size_t> set_anew;
  std::vector<std::size_t> others;
  for (const std::size_t row : jumps) (same[row] != 0 ? set_anew : others).push_back(row);
  if (!others.empty()) {
    out.notes.push_back(
        jumps_told(*q, others, "moves otherwise: recordings that were put together"));
    cut_movements(out.data, others);
  }
  if (!set_anew.empty()) {
    out.notes.push_back(jumps_told(*q, set_anew, "goes on as before: laid end to end"));
  }
  // No farther than the next recording, which has positions of its own.
  for (const std::size_t row : set_anew) {
    const double step =
        0.5 * (speed[row - 1] + speed[row + 1]) * (t->values[row] - t->values[row - 1]);
    const double offset = q->values[row - 1] + step - q->values[row];
    const int movement = out.data.movement[row];
    for (std::size_t i = row; i < out.data.rows() && out.data.movement[i] == movement; ++i) {
      q->values[i] += offset;
    }
  }
}

namespace {

// Over the rows from `first` to `last`, wherever the position starts again between them.
double mean_speed(const Channel& q, const std::vector<double>& time, std::size_t first,
                  std::size_t last, double turn) {
  double way = 0;
  for (std::size_t i = first + 1; i <= last; ++i) {
    way += std::remainder(q.values[i] - q.values[i - 1], turn);
  }
  return way / (time[last] - time[first]);
}

// How far the position goes into the row `row`, before which messages are lost: by the velocity
// where one is measured, else by the position's own speed before and after. gap: s, the shortest.
double way_across(const Dataset& data, const Channel& q, std::size_t row, double turn, double gap) {
  const std::vector<double>& time = data.find(Role::time)->values;
  const double dt = time[row] - time[row - 1];
  const Channel* v = data.find(Role::velocity);
  if (v != nullptr && v->unit == q.unit + "/s") {
    return 0.5 * (v->values[row - 1] + v->values[row]) * dt;
  }
  constexpr std::size_t kRows = 10;
  const auto follows = [&](std::size_t i) {
    return data.movement[i] == data.movement[i - 1] && time[i] - time[i - 1] <= gap;
  };
  std::size_t first = row - 1;
  while (first > 0 && row - first <= kRows && follows(first)) --first;
  std::size_t last = row;
  while (last + 1 < data.rows() && last - row < kRows && follows(last + 1)) ++last;
  if (first + 1 == row && last == row) return 0;
  if (last == row) return mean_speed(q, time, first, row - 1, turn) * dt;
  if (first + 1 == row) return mean_speed(q, time, row, last, turn) * dt;
  return 0.5 * dt *
         (mean_speed(q, time, first, row - 1, turn) + mean_speed(q, time, row, last, turn));
}

// How often the position starts again; what comes after each is moved by a turn.
std::size_t lay_end_to_end(const Dataset& data, Channel& q, double turn) {
  const Channel* t = data.find(Role::time);
  const double gap = t != nullptr ? 1.5 * median_step(t->values, data.movement) : 0;
  std::size_t wraps = 0;
  double offset = 0;
  for (std::size_t i = 1; i < data.rows(); ++i) {
    if (data.movement[i] != data.movement[i - 1]) {
      offset = 0;
      continue;
    }
    const bool lost = gap > 0 && t->values[i] - t->values[i - 1] > gap;
    const double expected = lost ? way_across(data, q, i, turn, gap) : 0;
    const double turns = std::round((expected - (q.values[i] + offset - q.values[i - 1])) / turn);
    offset += turns * turn;
    wraps += turns != 0 ? 1 : 0;
    q.values[i] += offset;
  }
  return wraps;
}

// Equal counts stay equal, as large as the turns may be.
void settle_on_counts(std::vector<double>& values, double count) {
  const auto is_whole = [&](double value) {
    return std::abs(value / count - std::round(value / count)) < 1e-3;
  };
  if (count <= 0 || !std::ranges::all_of(values, is_whole)) return;
  for (double& value : values) value = count * std::round(value / count);
}

}  // namespace

// A position that starts again after a turn is laid end to end.
void unwrap(PreparedRecording& out, const std::vector<ColumnReading>& readings,
            const Drive& drive) {
  Channel* q = find_channel(out.data, Role::position);
  if (q == nullptr) return;
  const auto reading = std::ranges::find(readings, Role::position, &ColumnReading::role);
  const bool is_read = reading != readings.end();
  const bool at_motor = is_read && reading->unit.ends_with("@motor");
  const bool in_counts = is_read && reading->unit.find("counts") != std::string::npos;
  const double count = in_counts ? std::abs(reading->factor) : 0;
  const Channel* t = find_channel(out.data, Role::time);
  const double turn = turn_of(*q, at_motor, drive, count, jumps_of(*q, t, out.data));
  const std::size_t wraps = turn > 0 ? lay_end_to_end(out.data, *q, turn) : 0;
  if (wraps == 0) return;
  settle_on_counts(q->values, count);
  out.notes.push_back(fmt::format("'{}' starts again {} times after {:.4g} {}: laid end to end",
                                  q->name, wraps, turn, q->unit));
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

namespace {

// Rows that follow one another evenly, from the instants at which their clock ticks: the line
// through those. False: the rows are not even, some stamp is more than a tick off.
bool spread_evenly(std::vector<double>& time, const RowRange& piece, double tick) {
  double n = 0;
  double mean_row = 0;
  double mean_time = 0;
  for (std::size_t i = piece.begin; i < piece.end; ++i) {
    ++n;
    mean_row += (static_cast<double>(i) - mean_row) / n;
    mean_time += (time[i] - mean_time) / n;
  }
  double rows = 0;
  double both = 0;
  for (std::size_t i = piece.begin; i < piece.end; ++i) {
    const double row = static_cast<double>(i) - mean_row;
    rows += row * row;
    both += row * (time[i] - mean_time);
  }
  if (!(both > 0)) return false;
  const double step = both / rows;
  std::vector<double> even;
  for (std::size_t i = piece.begin; i < piece.end; ++i) {
    even.push_back(mean_time + step * (static_cast<double>(i) - mean_row));
    if (std::abs(even.back() - time[i]) > tick) return false;
  }
  std::ranges::copy(even, time.begin() + static_cast<std::ptrdiff_t>(piece.begin));
  return true;
}

}  // namespace

// A clock that ticks more slowly than the rows come: between two gaps they are taken to be even.
void spread_coarse_stamps(PreparedRecording& out) {
  constexpr double kOften = 0.3;  // of the rows: fewer are messages that were sent twice
  // Fewer say nothing of how many rows a tick has: stamps since 1970 in single precision tick every
  // 128 s.
  constexpr std::size_t kFewestTicks = 10;
  Channel* t = find_channel(out.data, Role::time);
  if (t == nullptr) return;
  std::size_t repeats = 0;
  for (std::size_t i = 1; i < out.data.rows(); ++i) {
    repeats += out.data.movement[i] == out.data.movement[i - 1] && t->values[i] == t->values[i - 1];
  }
  if (static_cast<double>(repeats) < kOften * static_cast<double>(out.data.rows())) return;
  const double tick = median_step(t->values, out.data.movement);
  const std::vector<RowRange> pieces = pieces_of(t->values, out.data.movement, {});
  const std::size_t ticks = out.data.rows() - repeats;
  const bool even =
      ticks >= kFewestTicks && std::ranges::all_of(pieces, [&](const RowRange& piece) {
        return spread_evenly(t->values, piece, tick);
      });
  const std::string what = fmt::format(
      "{} of {} rows have the stamp of the row before in '{}', "
      "whose clock ticks every {:.3g} s",
      repeats, out.data.rows(), t->name, tick);
  if (!even) {
    throw_bad_input(
        what, out.data.name,
        "give the time's role to a finer column (stamps since 1970 need 17 digits), or to "
        "one that counts the samples: --roles 'COLUMN=time[2 ms]'");
  }
  out.notes.push_back(what + ": the rows between two gaps are taken to be even in time");
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
  leave_out(out, repeated_rows(q->values, noisy->values, out.data.movement),
            "repeat the row before in position and torque, as a bus does that lost its messages");
}

void drop_stuck_efforts(PreparedRecording& out) {
  for (const Role role : {Role::motor_torque, Role::motor_current}) {
    const Channel* q = find_channel(out.data, Role::position);
    const Channel* effort = find_channel(out.data, role);
    if (q == nullptr || effort == nullptr) continue;
    leave_out(
        out, stuck_rows(q->values, effort->values, out.data.movement),
        fmt::format("stand in a stretch of more than {} over which '{}' keeps its value while "
                    "the joint moves, as of a sensor that has stopped or a drive that is off",
                    kStuckRows, effort->name));
  }
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
