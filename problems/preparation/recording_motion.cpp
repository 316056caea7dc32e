// SPDX-License-Identifier: MIT
#include "problems/preparation/recording_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/order_statistics.hpp"
#include "problems/preparation/motion_check.hpp"
#include "problems/preparation/segments.hpp"

namespace tribench {
namespace {

constexpr std::size_t kEdgeRows = 3;      // of a derived motion, at the ends of a piece
constexpr double kUnresolved = 0.6;       // standard errors of the acceleration
constexpr double kLeastDelay = 0.6;       // steps of time
constexpr double kMuchNoisier = 4;        // than the derived velocity
constexpr double kNormalMedian = 1.4826;  // standard deviations in a median magnitude
constexpr double kForever = std::numeric_limits<double>::infinity();

}  // namespace

std::optional<DerivedMotion> derive_motion(const PreparedRecording& out) {
  const Channel* q = out.data.find(Role::position);
  const Channel* t = out.data.find(Role::time);
  if (q == nullptr || t == nullptr || !is_regular(t->values, out.data.movement)) return {};
  DerivedMotion derived;
  derived.pieces = pieces_of(t->values, out.data.movement, {});
  std::erase_if(derived.pieces,
                [](const RowRange& piece) { return piece.end - piece.begin < kFewestRows; });
  if (derived.pieces.empty()) return {};
  const MotionSmoother smoother(t->values, q->values, derived.pieces);
  derived.motion = smoother.smoothed();
  derived.slower = smoother.smoothed(0.5);
  return derived;
}

namespace {

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

// What a velocity has beside the derived one, as a standard deviation; where the smoother does not
// follow the two differ much, which the median does not see.
double noise_beside(const DerivedMotion& derived, const std::vector<double>& velocity) {
  std::vector<double> differences;
  for (const RowRange& piece : derived.pieces) {
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      differences.push_back(std::abs(velocity[i] - derived.motion.velocity[i]));
    }
  }
  return kNormalMedian * upper_median(std::move(differences));
}

}  // namespace

void settle_velocity(PreparedRecording& out, const DerivedMotion& derived) {
  const Channel* v = find_channel(out.data, Role::velocity);
  if (v == nullptr) {
    replace_velocity(out, derived);
    return;
  }
  const std::vector<double>& t = find_channel(out.data, Role::time)->values;
  const std::optional<double> delay =
      delay_of(t, derived.motion.velocity, v->values, derived.pieces);
  const double step = median_step(t, out.data.movement);
  // No filter runs ahead: a velocity that does was derived otherwise, and is left as it is.
  if (delay && *delay >= kLeastDelay * step) {
    out.notes.push_back(
        fmt::format("'{}' lags behind its position by {:.3g} ms, as a filtered velocity does",
                    v->name, 1e3 * *delay));
    replace_velocity(out, derived);
    return;
  }
  const double noise = noise_beside(derived, v->values);
  if (noise < kMuchNoisier * derived.motion.velocity_noise) return;
  out.notes.push_back(fmt::format("'{}' has more noise than its position gives ({:.2g} {})",
                                  v->name, noise, v->unit));
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
  // The inertia was not declared: it is no effect that friction lacks.
  if (out.data.find(Role::friction_torque) == nullptr)
    out.rigid.emplace_back("derived_acceleration");
}

namespace {

constexpr std::string_view kUnresolvedChannel = "acceleration not resolved";

}  // namespace

// Where the acceleration changes faster than the smoother follows, inertia would be taken for
// friction: there the whole and half of the bandwidth, with hardly a noise, differ. Marked here,
// dropped when the movements are cut.
void mark_unresolved(PreparedRecording& out, const DerivedMotion& derived) {
  if (out.data.find("derived_acceleration") == nullptr || out.data.find(Role::friction_torque)) {
    return;
  }
  const std::vector<double>& t = find_channel(out.data, Role::time)->values;
  Channel mark{std::string(kUnresolvedChannel), "-", Role::none, std::vector<double>(t.size(), 0)};
  const double blur = kBlur / (kRadPerTurn * derived.motion.bandwidth);
  double last = -kForever;  // when the acceleration was last seen to change
  const auto changes = [&](std::size_t i) {
    const double change = derived.slower.acceleration[i] - derived.motion.acceleration[i];
    return std::abs(change) > kUnresolved * derived.motion.acceleration_noise;
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

}  // namespace tribench
