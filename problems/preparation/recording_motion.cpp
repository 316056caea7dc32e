// SPDX-License-Identifier: MIT
#include "problems/preparation/recording_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/order_statistics.hpp"
#include "problems/preparation/effort_delay.hpp"
#include "problems/preparation/motion_check.hpp"
#include "problems/preparation/rigid_body.hpp"
#include "problems/preparation/segments.hpp"
#include "problems/preparation/steady_clock.hpp"

namespace tribench {
namespace {

constexpr std::size_t kEdgeRows = 3;  // of a derived motion, at the ends of a piece
constexpr double kUnresolved = 0.6;   // standard errors of the acceleration
constexpr double kMatters = 0.33;     // of the acceleration that the torque's noise leaves visible
constexpr double kQuarterStep = 0.2;  // of time, at least
constexpr double kMoreThanHalf = 0.6;
constexpr double kSurely = 3;        // standard errors
constexpr double kMuchCoarser = 4;   // than the derived velocity's noise
constexpr double kMuchNoisier = 10;  // a little: what a good controller knows beside its encoder

// Shorter ones make no stroke.
std::vector<RowRange> pieces_to_smooth(std::span<const double> time,
                                       std::span<const int> movement) {
  std::vector<RowRange> pieces = pieces_of(time, movement, {});
  std::erase_if(pieces,
                [](const RowRange& piece) { return piece.end - piece.begin < kFewestRows; });
  return pieces;
}

}  // namespace

void settle_clock(PreparedRecording& out) {
  const Channel* q = find_channel(out.data, Role::position);
  Channel* t = find_channel(out.data, Role::time);
  if (q == nullptr || t == nullptr || !is_regular(t->values, out.data.movement)) return;
  const std::vector<RowRange> pieces = pieces_of(t->values, out.data.movement, {});
  std::optional<SteadyClock> clock = steady_clock(t->values, pieces);
  if (!clock || motion_likelihood(clock->time, q->values, pieces) <=
                    motion_likelihood(t->values, q->values, pieces)) {
    return;
  }
  t->values = std::move(clock->time);
  out.notes.push_back(
      fmt::format("the stamps of '{}' jitter by {:.2g} ms about even instants, at which the "
                  "position moves more "
                  "smoothly: those are taken",
                  t->name, 1e3 * clock->jitter));
}

std::optional<DerivedMotion> derive_motion(const PreparedRecording& out) {
  const Channel* q = out.data.find(Role::position);
  const Channel* t = out.data.find(Role::time);
  if (q == nullptr || t == nullptr || !is_regular(t->values, out.data.movement)) return {};
  DerivedMotion derived;
  derived.pieces = pieces_to_smooth(t->values, out.data.movement);
  if (derived.pieces.empty()) return {};
  const MotionSmoother smoother(t->values, q->values, derived.pieces);
  derived.motion = smoother.smoothed();
  derived.slower = smoother.smoothed(0.5);
  return derived;
}

namespace {

// The noise of a velocity that has the other's motion: of their difference, what two neighbours do
// not foretell (von Neumann et al. 1941), by its median, which a few events leave alone.
double noise_beside(std::span<const double> velocity, std::span<const double> derived,
                    const std::vector<RowRange>& pieces) {
  constexpr double kMedianOfNormal = 0.6745;
  std::vector<double> bends;
  for (const RowRange& piece : pieces) {
    for (std::size_t i = piece.begin + 1; i + 1 < piece.end; ++i) {
      const auto off = [&](std::size_t at) { return velocity[at] - derived[at]; };
      bends.push_back(std::abs(off(i - 1) - 2 * off(i) + off(i + 1)));
    }
  }
  return bends.empty() ? 0 : median(bends) / (kMedianOfNormal * std::sqrt(6.0));
}

std::string motion_unit(const std::string& position, const char* per) { return position + per; }

void replace_velocity(PreparedRecording& out, const DerivedMotion& derived) {
  Channel* q = find_channel(out.data, Role::position);
  Channel* v = find_channel(out.data, Role::velocity);
  const Motion& motion = derived.motion;
  if (v == nullptr) {
    out.data.channels.push_back(
        {"derived_velocity", motion_unit(q->unit, "/s"), Role::velocity, motion.velocity});
  } else {
    v->values = motion.velocity;
  }
  q = find_channel(out.data, Role::position);
  q->values = motion.position;
  out.derived_velocity = true;
  out.notes.push_back(fmt::format(
      "velocity is derived from '{}' (Kalman smoother of {:.2g} Hz, no delay), noise {:.2g} {}/s",
      q->name, motion.bandwidth, motion.velocity_noise, q->unit));
}

}  // namespace

void settle_velocity(PreparedRecording& out, const DerivedMotion& derived) {
  const Channel* v = find_channel(out.data, Role::velocity);
  if (v == nullptr) {
    replace_velocity(out, derived);
    return;
  }
  const std::vector<double>& t = find_channel(out.data, Role::time)->values;
  const double step = median_step(t, out.data.movement);
  const double delay =
      delay_of(t, derived.motion.velocity, v->values, derived.pieces).value_or(0) / step;
  // Whether the torque goes with the derived one, in standard errors.
  const double preferred =
      torque_prefers(out.data, derived.motion.velocity, derived.motion.acceleration).value_or(0);
  const double noise = noise_beside(v->values, derived.motion.velocity, derived.pieces);
  const double count = resolution_of(v->values);
  std::string why;
  // No filter runs ahead: a velocity that does was derived otherwise, and is left as it is. Of half
  // a step and less the torque has to say whether the velocity is late, as a difference is (of rows
  // that were then thinned by less than half), or the position, as a simulator has it
  // (semi-implicit Euler). Of more it says nothing: friction that lags is like a velocity that
  // does.
  if (delay >= kMoreThanHalf || (delay >= kQuarterStep && preferred > kSurely)) {
    why = fmt::format("lags behind its position by {:.3g} ms, as a {} velocity does",
                      1e3 * step * delay, delay >= kMoreThanHalf ? "filtered" : "differenced");
  } else if (preferred < -kSurely) {
    return;  // speeds may have been commanded in even steps
  } else if (noise > kMuchNoisier * derived.motion.velocity_noise) {
    why =
        fmt::format("has a noise of {:.2g} {}, more than its position leaves open", noise, v->unit);
  } else if (count >= kMuchCoarser * derived.motion.velocity_noise) {
    why = fmt::format("is told in steps of {:.2g} {}, more than its position leaves open", count,
                      v->unit);
  } else {
    return;
  }
  out.notes.push_back(fmt::format("'{}' {}", v->name, why));
  replace_velocity(out, derived);
}

namespace {

// A single pass at one speed has its acceleration at its ends alone, where it is one with the
// speed: it would stand for whatever happens there.
bool is_one_pass(const PreparedRecording& out, const DerivedMotion& derived) {
  constexpr std::size_t kFewestStrokes = 3;
  if (out.data.movement_names.size() > 1) return false;
  const std::vector<double>& t = out.data.find(Role::time)->values;
  return strokes_of(t, derived.motion.velocity, derived.pieces, derived.motion.velocity_noise,
                    kFewestRows)
             .strokes.size() < kFewestStrokes;
}

}  // namespace

void settle_acceleration(PreparedRecording& out, const DerivedMotion& derived) {
  if (find_channel(out.data, Role::acceleration) != nullptr || is_one_pass(out, derived)) return;
  const std::string unit = find_channel(out.data, Role::position)->unit;
  out.data.channels.push_back({"derived_acceleration", motion_unit(unit, "/s^2"),
                               Role::acceleration, derived.motion.acceleration});
  out.notes.push_back(
      fmt::format("acceleration is derived from '{}' ({:.2g} Hz), noise {:.2g} {}/s^2",
                  find_channel(out.data, Role::position)->name, derived.motion.bandwidth,
                  derived.motion.acceleration_noise, unit));
  add_undeclared_inertia(out);
}

void add_undeclared_inertia(PreparedRecording& out) {
  const Channel* a = find_channel(out.data, Role::acceleration);
  if (a == nullptr || out.data.find(Role::friction_torque) != nullptr) return;
  if (std::ranges::count(out.rigid, a->name) == 0) out.rigid.push_back(a->name);
}

// Inertia couples joints by their accelerations: without the other's its velocity says little.
void settle_other_acceleration(PreparedRecording& out) {
  const Channel* v = find_channel(out.data, Role::other_velocity);
  const Channel* t = find_channel(out.data, Role::time);
  if (v == nullptr || t == nullptr || find_channel(out.data, Role::other_acceleration) != nullptr ||
      !is_regular(t->values, out.data.movement)) {
    return;
  }
  const std::vector<RowRange> pieces = pieces_to_smooth(t->values, out.data.movement);
  if (pieces.empty()) return;
  // The smoother's velocity is the first derivative of what it is given.
  Motion motion = MotionSmoother(t->values, v->values, pieces).smoothed();
  out.notes.push_back(
      fmt::format("the other joint's acceleration is derived from '{}' ({:.2g} Hz), noise {:.2g} "
                  "{}^2",
                  v->name, motion.bandwidth, motion.velocity_noise, v->unit));
  out.data.channels.push_back({"derived_other_acceleration", v->unit + "^2",
                               Role::other_acceleration, std::move(motion.velocity)});
}

namespace {

constexpr std::string_view kUnresolvedChannel = "acceleration not resolved";
constexpr std::string_view kChangeChannel = "acceleration less that of half the bandwidth";
constexpr double kMostBlunted = 2;  // shares of the change

bool has_inertia_of_derived(const Dataset& data) {
  return data.find("derived_acceleration") != nullptr &&
         data.find(Role::friction_torque) == nullptr;
}

void erase_channel(Dataset& data, std::string_view name) {
  std::erase_if(data.channels, [&](const Channel& channel) { return channel.name == name; });
}

// Stretches of rows in one direction in which the change exceeds `least` again and again, at most
// `near` apart in time. One that turns many times, well above the noise, is no ramp but a
// vibration, such as a gear's ripple gives the joint: on the mean its error is none, and with it
// whole strokes would go.
std::vector<RowRange> fast_ramps(std::span<const double> change, std::span<const double> t,
                                 std::span<const double> v, double least, double noise,
                                 double near) {
  constexpr int kMostTurns = 12;  // of a stroke's two ramps, three at each beginning and end
  std::vector<RowRange> ramps;
  int turns = 0;
  double largest = 0;
  double before = 0;
  const auto end_stretch = [&] {
    if (turns > kMostTurns && largest > kSurely * noise) ramps.pop_back();
    turns = 0;
    largest = before = 0;
  };
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!(std::abs(change[i]) > least)) continue;
    const std::size_t last = ramps.empty() ? 0 : ramps.back().end - 1;
    if (ramps.empty() || !(std::abs(t[i] - t[last]) <= near) || v[i] * v[last] < 0) {
      end_stretch();
      ramps.push_back({i, i});
    }
    ramps.back().end = i + 1;
    turns += change[i] * before < 0 ? 1 : 0;
    largest = std::max(largest, std::abs(change[i]));
    before = change[i];
  }
  end_stretch();
  return ramps;
}

}  // namespace

// Where the motion changes faster than the smoother follows, what it leaves of the acceleration, or
// of a derived velocity beside a friction torque, would be taken for friction: there the whole and
// half of the bandwidth, with hardly a noise, differ. Marked here, dropped when the movements are
// cut.
void mark_unresolved(PreparedRecording& out, const DerivedMotion& derived) {
  const bool is_inertia = has_inertia_of_derived(out.data);
  const bool is_friction = out.derived_velocity && out.data.find(Role::friction_torque) != nullptr;
  if (!is_inertia && !is_friction) return;
  const auto part = is_inertia ? &Motion::acceleration : &Motion::velocity;
  const double noise =
      is_inertia ? derived.motion.acceleration_noise : derived.motion.velocity_noise;
  const std::optional<double> visible =
      is_inertia ? visible_acceleration(out.data) : visible_velocity(out.data);
  Channel change{std::string(kChangeChannel), "-", Role::none, derived.motion.*part};
  for (std::size_t i = 0; i < change.values.size(); ++i) {
    change.values[i] -= (derived.slower.*part)[i];
  }
  const std::vector<double>& t = find_channel(out.data, Role::time)->values;
  Channel mark{std::string(kUnresolvedChannel), "-", Role::none, std::vector<double>(t.size(), 0)};
  const double blur = kBlur / (kRadPerTurn * derived.motion.bandwidth);
  const double least = std::max(kUnresolved * noise, kMatters * visible.value_or(0));
  const std::vector<RowRange> ramps =
      fast_ramps(change.values, t, derived.motion.velocity, least, noise, 2 * blur);
  for (RowRange ramp : ramps) {
    const double begin = t[ramp.begin] - blur;
    const double end = t[ramp.end - 1] + blur;
    while (ramp.begin > 0 && t[ramp.begin - 1] >= begin && t[ramp.begin - 1] <= end) --ramp.begin;
    while (ramp.end < t.size() && t[ramp.end] <= end && t[ramp.end] >= begin) ++ramp.end;
    std::fill(mark.values.begin() + static_cast<std::ptrdiff_t>(ramp.begin),
              mark.values.begin() + static_cast<std::ptrdiff_t>(ramp.end), 1);
  }
  out.data.channels.push_back(std::move(mark));
  if (is_inertia) out.data.channels.push_back(std::move(change));
}

// An inertia that one movement alone tells cannot be judged by leaving movements out: there its
// error is taken for whatever else is asked about.
void drop_lonely_acceleration(PreparedRecording& out) {
  constexpr double kAlone = 0.5;  // of the sum of squares
  constexpr std::size_t kFewestMovements = 5;
  const Channel* a = out.data.find("derived_acceleration");
  const std::size_t movements = out.data.movement_names.size();
  if (a == nullptr || !has_inertia_of_derived(out.data) || movements < kFewestMovements) return;
  std::vector<char> lonely(out.data.rows(), 0);
  for (std::size_t round = 0; round < movements; ++round) {
    std::vector<double> squares(movements, 0.0);
    std::vector<double> largest(movements, 0.0);
    double all = 0;
    for (std::size_t i = 0; i < lonely.size(); ++i) {
      if (lonely[i] != 0) continue;
      const auto m = static_cast<std::size_t>(out.data.movement[i]);
      squares[m] += a->values[i] * a->values[i];
      largest[m] = std::max(largest[m], std::abs(a->values[i]));
      all += a->values[i] * a->values[i];
    }
    const auto most = static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
    if (squares[most] <= kAlone * all) break;
    largest[most] = 0;
    const double others = *std::ranges::max_element(largest);
    bool any = false;
    for (std::size_t i = 0; i < lonely.size(); ++i) {
      if (lonely[i] != 0 || static_cast<std::size_t>(out.data.movement[i]) != most) continue;
      if (std::abs(a->values[i]) <= others) continue;
      lonely[i] = 1;
      any = true;
    }
    if (!any) break;
  }
  leave_out(out, lonely,
            "accelerate as no other movement does, so that no other tells the inertia");
}

// A column of which half is noise has half of its coefficient at most, and takes the other half
// from whatever goes with it: no inertia.
void drop_unseen_acceleration(PreparedRecording& out, double noise) {
  const Channel* a = out.data.find("derived_acceleration");
  if (a == nullptr || !has_inertia_of_derived(out.data)) return;
  double square = 0;
  for (const double value : a->values) square += value * value;
  const double size = std::sqrt(square / static_cast<double>(a->values.size()));
  if (size >= noise) return;
  out.notes.push_back(fmt::format(
      "the rows left accelerate by {:.2g} {} (root mean square), no more than its noise: no "
      "inertia can be told, and none is in the formulas",
      size, a->unit));
  std::erase(out.rigid, a->name);
  erase_channel(out.data, "derived_acceleration");
}

void drop_unresolved(PreparedRecording& out) {
  const Channel* mark = out.data.find(kUnresolvedChannel);
  if (mark == nullptr) return;
  const std::vector<char> rows(mark->values.begin(), mark->values.end());
  erase_channel(out.data, kUnresolvedChannel);
  const auto count = static_cast<std::size_t>(std::ranges::count(rows, 1));
  if (3 * count > 2 * rows.size()) return;  // too little would be left to ask
  out.unresolved = count;
  leave_out(out, rows, "change their motion faster than the position's noise lets be seen");
}

void adjust_acceleration(PreparedRecording& out) {
  const Channel* change = out.data.find(kChangeChannel);
  if (change == nullptr) return;
  const std::optional<Blunting> blunting = acceleration_blunting(out.data, change->values);
  if (blunting && std::abs(blunting->share) > kSurely * blunting->error) {
    const double share = std::clamp(blunting->share, -1.0, kMostBlunted);
    Channel& a = *find_channel(out.data, Role::acceleration);
    for (std::size_t i = 0; i < a.values.size(); ++i) a.values[i] += share * change->values[i];
    out.notes.push_back(
        fmt::format("the torque tells the acceleration too: it is moved by {:.0f} % of its way {} "
                    "that of half the bandwidth",
                    100 * std::abs(share), share < 0 ? "towards" : "away from"));
  }
  erase_channel(out.data, kChangeChannel);
}

namespace {

// What comes with the delay of a torque that is measured.
bool is_effort(Role role) {
  return role == Role::motor_torque || role == Role::motor_current ||
         role == Role::friction_torque || role == Role::external_torque;
}

// A bus brings a torque late, a filter smears it, too: friction's step where the motion turns would
// pass for a friction that follows its velocity late. The rows into which a filter of that delay
// would smear one; of the motion as it was recorded.
std::vector<char> unsettled_rows(const Dataset& data, double delay) {
  const std::vector<double>& t = data.find(Role::time)->values;
  const std::vector<double>& v = data.find(Role::velocity)->values;
  std::vector<char> rows(data.rows(), 0);
  double turned = -INFINITY;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (data.movement[i] != data.movement[i - 1]) {
      turned = -INFINITY;
    } else if (v[i] * v[i - 1] <= 0) {
      turned = t[i];
    }
    rows[i] = t[i] - turned < kFilterSettles * delay ? 1 : 0;
  }
  return rows;
}

// The mark of a row holds for the instants beside it.
void round_up(Channel& mark) {
  for (double& one : mark.values) one = std::ceil(one);
}

}  // namespace

void settle_effort(PreparedRecording& out, const Drive& drive) {
  const Channel* time = find_channel(out.data, Role::time);
  if (time == nullptr || !is_regular(time->values, out.data.movement)) return;
  const std::vector<double> t = time->values;
  const std::vector<RowRange> pieces = pieces_of(t, out.data.movement, {});
  const Channel* change = out.data.find(kChangeChannel);
  const std::optional<EffortDelay> delay =
      effort_delay(out.data, pieces, drive.gear_ratio,
                   change != nullptr ? change->values : std::span<const double>{});
  if (!delay || !is_surely_late(*delay)) return;
  std::vector<char> lost(out.data.rows(), 0);
  const std::vector<char> unsettled = unsettled_rows(out.data, delay->value);
  std::string names;
  for (Channel& channel : out.data.channels) {
    if (is_effort(channel.role)) {
      names += (names.empty() ? "'" : " and '") + channel.name + "'";
    } else if (channel.role != Role::time) {
      // The motion is smooth, the torque is not: between its rows nobody knows it.
      Shifted shifted = delay->is_filter ? filtered_by(t, channel.values, pieces, delay->value)
                                         : shifted_by(t, channel.values, pieces, -delay->value);
      channel.values = std::move(shifted.values);
      lost = std::move(shifted.lost);
      if (channel.name == kUnresolvedChannel) round_up(channel);
    }
  }
  out.notes.push_back(fmt::format(
      "{} comes {:.3g} ms after the motion that it belongs to (+/- {:.2g} ms{}): beside it stands "
      "the motion of then",
      names, 1e3 * delay->value, 1e3 * delay->error,
      delay->is_filter ? ", as through a first-order filter" : ""));
  for (std::size_t i = 0; i < lost.size(); ++i) {
    if (unsettled[i] != 0) lost[i] = 1;
  }
  leave_out(
      out, lost,
      "have no motion of their torque's instant, or follow a reversal so closely that a filter "
      "as late would smear friction's step over them");
}

// Rows of no piece have no derived motion, and the ends of a piece a poor one.
void drop_edges(PreparedRecording& out, const DerivedMotion& derived) {
  std::vector<std::size_t> kept;
  for (const RowRange& piece : derived.pieces) {
    for (std::size_t i = piece.begin + kEdgeRows; i + kEdgeRows < piece.end; ++i) kept.push_back(i);
  }
  keep_rows(out.data, kept);
}

}  // namespace tribench
