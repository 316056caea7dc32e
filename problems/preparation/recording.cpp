// SPDX-License-Identifier: MIT
#include "problems/preparation/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "problems/preparation/motion_check.hpp"
#include "problems/preparation/motion_smoother.hpp"
#include "problems/preparation/rigid_body.hpp"
#include "problems/preparation/segments.hpp"
#include "problems/reading/explanation.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kMostStrokes = 150;  // more say no more of independence
constexpr std::size_t kFewestRows = 8;     // of a stroke
constexpr std::size_t kEdgeRows = 3;       // of a derived motion, at the ends of a piece
constexpr double kBlur = 3;                // time constants of the smoother
constexpr double kUnresolved = 3;          // standard errors of the acceleration
constexpr double kLeastDelay = 0.6;        // steps of time
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kMuchExplained = 0.3;
constexpr double kSure = 10;  // standard errors
constexpr double kSameFactor = 0.08;

Channel* find(Dataset& data, Role role) {
  const auto found = std::ranges::find(data.channels, role, &Channel::role);
  return found == data.channels.end() ? nullptr : &*found;
}

// ---- torque --------------------------------------------------------------------------------

// Two quantities of different units are never subtracted.
void check_units(const PreparedRecording& out) {
  const Channel* gravity = out.data.find(Role::gravity_torque);
  const Channel* torque = out.data.find(Role::motor_torque);
  if (torque == nullptr) torque = out.data.find(Role::motor_current);
  if (gravity == nullptr || torque == nullptr || out.data.find(Role::friction_torque)) return;
  if (gravity->unit == torque->unit || torque->unit == "V") return;
  if (torque->unit == "A") {
    throw_bad_input(
        fmt::format("'{}' is in A and '{}' in {}", torque->name, gravity->name, gravity->unit),
        out.data.name,
        fmt::format("give --torque-constant K (N m/A at the joint, or K@motor with --gear-ratio), "
                    "or leave gravity out: --roles '{}=none'",
                    gravity->name));
  }
  const Channel* unknown = gravity->unit == "-" ? gravity : torque->unit == "-" ? torque : nullptr;
  if (unknown == nullptr) return;
  throw_bad_input(fmt::format("the unit of '{}' is not known", unknown->name), out.data.name,
                  fmt::format("say it: --roles '{}={}[N m]' (or N, A, V)", unknown->name,
                              role_name(unknown->role)));
}

// ---- rows ----------------------------------------------------------------------------------

void keep_rows(Dataset& data, const std::vector<std::size_t>& rows) {
  if (rows.size() < data.rows()) data = select_rows({data, {}}, rows).data;
}

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
  if (std::abs(largest - kTurn) < 0.1 * kTurn) return kTurn;
  const auto alike = std::ranges::count_if(
      steps, [&](double step) { return std::abs(step - largest) < 2 * usual; });
  return alike >= 3 ? largest : 0;
}

// An angle that starts again after a turn is laid end to end.
void unwrap(PreparedRecording& out) {
  Channel* q = find(out.data, Role::position);
  if (q == nullptr || q->unit != "rad") return;
  const double turn = turn_of(*q, find(out.data, Role::time), out.data);
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
  const Channel* t = find(out.data, Role::time);
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
  const Channel* q = find(out.data, Role::position);
  const Channel* noisy = find(out.data, Role::motor_torque);
  if (noisy == nullptr) noisy = find(out.data, Role::motor_current);
  if (q == nullptr || noisy == nullptr) return;
  leave_out(out, repeated_rows(q->values, noisy->values),
            "repeat the row before in position and torque, as a bus does that lost its messages");
}

void drop_clipped(PreparedRecording& out) {
  for (const Role role : {Role::motor_torque, Role::motor_current}) {
    const Channel* torque = find(out.data, role);
    if (torque == nullptr) continue;
    leave_out(out, clipped_rows(torque->values),
              fmt::format("have '{}' at its limit", torque->name));
  }
}

// ---- motion --------------------------------------------------------------------------------

struct DerivedMotion {
  std::vector<double> measured;  // the position
  Motion motion;
  Motion slow;  // of half the bandwidth: what the acceleration is taken from
  std::vector<RowRange> pieces;
};

std::optional<DerivedMotion> derive_motion(const PreparedRecording& out) {
  const Channel* q = out.data.find(Role::position);
  const Channel* t = out.data.find(Role::time);
  if (q == nullptr || t == nullptr || !is_regular(t->values, out.data.movement)) return {};
  DerivedMotion derived;
  derived.pieces = pieces_of(t->values, out.data.movement, {});
  std::erase_if(derived.pieces,
                [](const RowRange& piece) { return piece.end - piece.begin < kFewestRows; });
  if (derived.pieces.empty()) return {};
  derived.measured = q->values;
  derived.motion = smooth_motion(t->values, derived.measured, derived.pieces);
  // An acceleration's noise grows with the bandwidth to the power of 5/2: half of it costs little
  // where the motion is slow, and where it is not the rows are left out (mark_unresolved).
  derived.slow =
      smooth_motion(t->values, derived.measured, derived.pieces, 0.5 * derived.motion.bandwidth);
  return derived;
}

std::string motion_unit(const std::string& position, const char* per) { return position + per; }

void replace_velocity(PreparedRecording& out, const DerivedMotion& derived) {
  Channel* q = find(out.data, Role::position);
  Channel* v = find(out.data, Role::velocity);
  const Motion& motion = derived.motion;
  if (v == nullptr) {
    out.data.channels.push_back(
        {"derived_velocity", motion_unit(q->unit, "/s"), Role::velocity, motion.velocity});
  } else {
    v->values = motion.velocity;
  }
  q = find(out.data, Role::position);
  q->values = motion.position;
  out.derived_velocity = true;
  out.notes.push_back(fmt::format(
      "velocity is derived from '{}' (Kalman smoother of {:.2g} Hz, no delay), noise {:.2g} {}/s",
      q->name, motion.bandwidth, motion.velocity_noise, q->unit));
}

void settle_velocity(PreparedRecording& out, const DerivedMotion& derived) {
  const Channel* v = find(out.data, Role::velocity);
  if (v == nullptr) {
    replace_velocity(out, derived);
    return;
  }
  const std::vector<double>& t = find(out.data, Role::time)->values;
  const std::optional<double> delay =
      delay_of(t, derived.motion.velocity, v->values, derived.pieces);
  const double step = median_step(t, out.data.movement);
  // No filter runs ahead: a velocity that does was derived otherwise, and is left as it is.
  if (!delay || *delay < kLeastDelay * step) return;
  out.notes.push_back(
      fmt::format("'{}' lags behind its position by {:.3g} ms, as a filtered velocity does",
                  v->name, 1e3 * *delay));
  replace_velocity(out, derived);
}

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

void settle_acceleration(PreparedRecording& out, const DerivedMotion& derived) {
  if (find(out.data, Role::acceleration) != nullptr || is_one_pass(out, derived)) return;
  const std::string unit = find(out.data, Role::position)->unit;
  out.data.channels.push_back({"derived_acceleration", motion_unit(unit, "/s^2"),
                               Role::acceleration, derived.slow.acceleration});
  out.notes.push_back(
      fmt::format("acceleration is derived from '{}' ({:.2g} Hz), noise {:.2g} {}/s^2",
                  find(out.data, Role::position)->name, derived.slow.bandwidth,
                  derived.slow.acceleration_noise, unit));
  // Nobody said anything of the inertia: it is no effect that friction lacks.
  if (out.data.find(Role::friction_torque) == nullptr)
    out.rigid.emplace_back("derived_acceleration");
}

constexpr std::string_view kUnresolvedChannel = "acceleration not resolved";

// Where the acceleration changes faster than the smoother follows, inertia would be taken for
// friction: there half and a quarter of the bandwidth, with hardly a noise, differ. Marked here,
// dropped when the movements are cut.
void mark_unresolved(PreparedRecording& out, const DerivedMotion& derived) {
  if (out.data.find("derived_acceleration") == nullptr || out.data.find(Role::friction_torque)) {
    return;
  }
  const std::vector<double>& t = find(out.data, Role::time)->values;
  const Motion slower =
      smooth_motion(t, derived.measured, derived.pieces, 0.25 * derived.motion.bandwidth);
  Channel mark{std::string(kUnresolvedChannel), "-", Role::none, std::vector<double>(t.size(), 0)};
  const double blur = kBlur / (kTurn * derived.slow.bandwidth);
  double last = -kForever;  // when the acceleration was last seen to change
  const auto changes = [&](std::size_t i) {
    const double change = slower.acceleration[i] - derived.slow.acceleration[i];
    return std::abs(change) > kUnresolved * derived.slow.acceleration_noise;
  };
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (changes(i)) last = t[i];
    mark.values[i] = std::abs(t[i] - last) <= blur ? 1 : 0;
  }
  last = kForever;
  for (std::size_t i = t.size(); i-- > 0;) {
    if (changes(i)) last = t[i];
    if (std::abs(t[i] - last) <= blur) mark.values[i] = 1;
  }
  out.data.channels.push_back(std::move(mark));
}

void drop_unresolved(PreparedRecording& out) {
  const Channel* mark = out.data.find(kUnresolvedChannel);
  if (mark == nullptr) return;
  const std::vector<char> rows(mark->values.begin(), mark->values.end());
  std::erase_if(out.data.channels,
                [](const Channel& channel) { return channel.name == kUnresolvedChannel; });
  if (2 * static_cast<std::size_t>(std::ranges::count(rows, 1)) > rows.size()) return;
  leave_out(out, rows, "change their acceleration faster than the position's noise lets be seen");
}

// Rows of no piece have no derived motion, and the ends of a piece a poor one.
void drop_edges(PreparedRecording& out, const DerivedMotion& derived) {
  std::vector<std::size_t> kept;
  for (const RowRange& piece : derived.pieces) {
    for (std::size_t i = piece.begin + kEdgeRows; i + kEdgeRows < piece.end; ++i) kept.push_back(i);
  }
  keep_rows(out.data, kept);
}

// ---- movements -----------------------------------------------------------------------------

// Strokes that follow one another without a rest go together until few enough are left.
std::vector<std::vector<RowRange>> grouped(const std::vector<RowRange>& strokes,
                                           const Dataset& data, std::span<const double> time,
                                           double longest) {
  const std::size_t together = (strokes.size() + kMostStrokes - 1) / kMostStrokes;
  std::vector<std::vector<RowRange>> groups;
  for (const RowRange& stroke : strokes) {
    const bool fits = !groups.empty() && groups.back().size() < together &&
                      time[stroke.begin] - time[groups.back().back().end - 1] <= longest &&
                      data.movement[groups.back().back().begin] == data.movement[stroke.begin];
    if (fits) {
      groups.back().push_back(stroke);
    } else {
      groups.push_back({stroke});
    }
  }
  return groups;
}

// Around a rest or a reversal a smoothed velocity says nothing for as long as the smoother sees:
// what friction does there would pass for an effect of slow speed.
std::vector<RowRange> without_ends(const std::vector<RowRange>& strokes,
                                   std::span<const double> time, double blur) {
  std::vector<RowRange> inner;
  for (RowRange stroke : strokes) {
    const double begin = time[stroke.begin] + blur;
    const double end = time[stroke.end - 1] - blur;
    while (stroke.begin < stroke.end && time[stroke.begin] < begin) ++stroke.begin;
    while (stroke.end > stroke.begin && time[stroke.end - 1] > end) --stroke.end;
    if (stroke.end - stroke.begin >= kFewestRows) inner.push_back(stroke);
  }
  return inner;
}

// blur: s that the velocity is uncertain around a rest or a reversal.
void cut_strokes(PreparedRecording& out, double noise, double blur) {
  const Channel* t = find(out.data, Role::time);
  const Channel* v = find(out.data, Role::velocity);
  if (t == nullptr || v == nullptr || !is_regular(t->values, out.data.movement)) return;
  Strokes found = strokes_of(t->values, v->values, pieces_of(t->values, out.data.movement, {}),
                             noise, kFewestRows);
  if (blur > 0) found.strokes = without_ends(found.strokes, t->values, blur);
  if (found.strokes.size() < 2) return;
  const double longest = 2 * blur + 3 * median_step(t->values, out.data.movement);
  const std::size_t all = out.data.rows();
  const std::size_t files = out.data.movement_names.size();
  std::vector<std::size_t> rows;
  std::vector<int> movement;
  std::vector<std::string> names;
  for (const std::vector<RowRange>& group : grouped(found.strokes, out.data, t->values, longest)) {
    const auto file = static_cast<std::size_t>(out.data.movement[group.front().begin]);
    names.push_back(
        files > 1 ? fmt::format("{}, stroke {}", out.data.movement_names[file], names.size() + 1)
                  : fmt::format("stroke {}", names.size() + 1));
    for (const RowRange& stroke : group) {
      for (std::size_t i = stroke.begin; i < stroke.end; ++i) {
        rows.push_back(i);
        movement.push_back(static_cast<int>(names.size()) - 1);
      }
    }
  }
  keep_rows(out.data, rows);
  out.data.movement = std::move(movement);
  out.data.movement_names = std::move(names);
  out.notes.push_back(fmt::format(
      "no column names the movements: {} strokes between {} rests and {} reversals make {}; {:.0f} "
      "% of the rows, at rest or in shorter strokes, are left out",
      found.strokes.size(), found.rests, found.reversals, out.data.movement_names.size(),
      100.0 * static_cast<double>(all - out.data.rows()) / static_cast<double>(all)));
}

// ---- gravity -------------------------------------------------------------------------------

void check_gravity_factor(const PreparedRecording& out, const DataOptions& options) {
  const Channel* gravity = out.data.find(Role::gravity_torque);
  const Channel* torque = out.data.find(Role::motor_torque);
  if (torque == nullptr) torque = out.data.find(Role::motor_current);
  if (gravity == nullptr || torque == nullptr || gravity->unit != torque->unit) return;
  const std::optional<GravityFactor> factor = gravity_factor(out.data);
  if (!factor || std::abs(factor->value) < kSure * factor->error) return;
  const double value = factor->value;
  const auto is = [&](double known) {
    return std::abs(elementary::log(std::abs(value) / known)) < kSameFactor;
  };
  const std::string what = fmt::format("'{}' goes into '{}' with the factor {:.3g}, not 1",
                                       gravity->name, torque->name, value);
  if (value < 0 && is(1)) {
    throw_bad_input(what, out.data.name,
                    "one of the two has its sign turned: gravity is the torque that the motor has "
                    "to hold; turn it in the file, or let it be fitted: --gravity fit");
  }
  for (const double known : {1e3, 1e-3, options.drive.gear_ratio.value_or(0),
                             1 / options.drive.gear_ratio.value_or(1e300)}) {
    if (known <= 0 || !is(known) || is(1)) continue;
    throw_bad_input(what, out.data.name,
                    "check their units (--roles COLUMN=ROLE[UNIT]), --torque-constant and the side "
                    "of the gear (@motor)");
  }
}

void refuse_turned_sign(const PreparedRecording& out, const RigidBody& body) {
  if (body.friction > -kSure * body.friction_error) return;
  throw_bad_input(
      fmt::format("friction opposes the velocity here ({:.3g} at the typical speed, inertia and "
                  "gravity taken off); it is expected positive with velocity",
                  body.friction),
      out.data.name, "turn the torque's sign with --flip-sign");
}

void add_rigid(PreparedRecording& out, const Channel& channel) {
  out.rigid.push_back(channel.name);
  out.data.channels.push_back(channel);
}

void fit_gravity(PreparedRecording& out, Gravity gravity) {
  if (out.data.find(Role::friction_torque) != nullptr ||
      out.data.find(Role::gravity_torque) != nullptr) {
    if (gravity != Gravity::fit) return;
    throw_bad_input("a column declares the gravity torque, or there is a friction torque",
                    "--gravity fit", "leave --gravity out, or take the role away: COLUMN=none");
  }
  const std::optional<RigidBody> body = fit_rigid_body(out.data);
  if (!body) {
    if (gravity != Gravity::fit) return;
    throw_bad_input(
        "gravity cannot be fitted: it needs an angle that covers 0.3 rad or more, and "
        "a motor torque or current",
        "--gravity fit", "declare it: --roles COLUMN=gravity_torque[N m]");
  }
  refuse_turned_sign(out, *body);
  const bool much = body->explained > kMuchExplained && body->certainty > kSure;
  if (gravity == Gravity::none) {
    if (much) {
      out.notes.push_back(
          fmt::format("sin and cos of the position explain {:.0f} % of what friction leaves: "
                      "--gravity fit takes that gravity off",
                      100 * body->explained));
    }
    return;
  }
  if (gravity == Gravity::automatic && !much) return;
  const std::vector<double> angle = out.data.find(Role::position)->values;
  const Channel* torque = out.data.find(Role::motor_torque);
  if (torque == nullptr) torque = out.data.find(Role::motor_current);
  Channel sine{"sin_q", "-", Role::none, {}};
  Channel cosine{"cos_q", "-", Role::none, {}};
  Channel load{"fitted_gravity", torque->unit, Role::gravity_torque, {}};
  for (const double q : angle) {
    sine.values.push_back(elementary::sin(q));
    cosine.values.push_back(elementary::cos(q));
    load.values.push_back(body->sine * sine.values.back() + body->cosine * cosine.values.back());
  }
  out.notes.push_back(fmt::format(
      "gravity that no column declares is fitted with the base ({:.4g} {} at most; it explains "
      "{:.0f} % of what friction and inertia leave){}",
      std::sqrt(body->sine * body->sine + body->cosine * body->cosine), torque->unit,
      100 * body->explained,
      gravity == Gravity::fit ? "" : ", as --gravity fit does; --gravity none leaves it out"));
  add_rigid(out, sine);
  add_rigid(out, cosine);
  out.data.channels.push_back(load);
  const Channel* a = out.data.find(Role::acceleration);
  if (a != nullptr && std::ranges::count(out.rigid, a->name) == 0) out.rigid.push_back(a->name);
}

}  // namespace

PreparedRecording prepare(DataFile file, const DataOptions& options, Gravity gravity) {
  check_complete(file);
  PreparedRecording out;
  out.notes = file.warnings;
  if (file.dropped_rows > 0) {
    out.notes.push_back(fmt::format("{} rows with missing values dropped", file.dropped_rows));
  }
  for (std::string& one : what_was_converted(file)) out.notes.push_back(std::move(one));
  out.data = std::move(file.data);
  if (std::string made = make_torque(out.data, options); !made.empty()) {
    out.notes.push_back(std::move(made));
  }
  check_units(out);
  drop_repeated_stamps(out);
  drop_repeated_messages(out);
  unwrap(out);
  file.data = std::move(out.data);
  check_motion(file, options.drive.gear_ratio);
  out.data = std::move(file.data);
  double noise = 0;
  double blur = 0;
  if (const std::optional<DerivedMotion> derived = derive_motion(out)) {
    noise = derived->motion.velocity_noise;
    settle_velocity(out, *derived);
    settle_acceleration(out, *derived);
    mark_unresolved(out, *derived);
    blur = kBlur / (kTurn * derived->motion.bandwidth);
    if (out.derived_velocity) drop_edges(out, *derived);
  } else if (out.data.find(Role::velocity) == nullptr) {
    throw_bad_input(
        "there is no velocity, and the rows are too uneven or too far apart in time to "
        "derive it",
        out.data.name, "name the velocity's column: --roles COLUMN=velocity[UNIT]");
  }
  drop_clipped(out);
  // A file with all of its motion was prepared by somebody: its movement is what it is.
  const bool raw = out.derived_velocity || out.data.find("derived_acceleration") != nullptr;
  if (!file.has_movements && raw) cut_strokes(out, noise, blur);
  drop_unresolved(out);
  check_gravity_factor(out, options);
  fit_gravity(out, gravity);
  return out;
}

}  // namespace tribench
