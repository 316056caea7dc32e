// SPDX-License-Identifier: MIT
#include "problems/preparation/derived_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/sign.hpp"

namespace tribench::loop {
namespace {

double rounded_step(double dt) {
  constexpr double kClock = 1e-5;
  return dt > 100 * kClock ? kClock * std::round(dt / kClock) : dt;
}

constexpr std::string_view kDerived = " (derived)";
constexpr std::string_view kLate = "v_lag";
constexpr std::string_view kSettles = "sgn_v_lag";

}  // namespace

double DistanceSinceReversal::next(double v, double q, double dt) {
  const double now = sign(v);
  if (!started_) {
    distance_ = 0;
    direction_ = now;
    started_ = true;
  } else if (now != 0 && now != direction_) {
    const double part = std::abs(v) / (std::abs(v) + std::abs(v_));
    distance_ = 0.5 * std::abs(v) * part * dt;
    direction_ = now;
  } else {
    const double step = from_ == PathFrom::position ? q - q_ : v * dt;
    distance_ += std::abs(step);
  }
  v_ = v;
  q_ = q;
  return distance_;
}

bool starts_from_rest(double first, double second, double standstill) {
  const double one = std::abs(first);
  return std::min(one, 2 * one - std::abs(second)) < standstill;
}

double TimeLag::next(double x, double dt_s) {
  if (count_ == 0) {
    now_ = 0;
    first_ = 0;
    count_ = 1;
    oldest() = {0, x};
    return x;
  }
  now_ += dt_s;
  const double then = now_ - lag_s_;
  while (count_ > 1 && oldest(1).time <= then) {
    first_ = (first_ + 1) % kSlots;
    --count_;
  }
  const Row before = oldest();
  const Row after = count_ > 1 ? oldest(1) : Row{now_, x};
  // Of 33 spacings and a row over, none is forgotten before its time.
  const double spacing = lag_s_ / 32;
  if (count_ < kSlots && now_ - oldest(count_ - 1).time >= spacing) oldest(count_++) = {now_, x};
  if (!(then > before.time)) return before.x;
  return before.x + (then - before.time) / (after.time - before.time) * (after.x - before.x);
}

double SettlingSign::next(double v, double dt_s) {
  const double now = sign(v);
  if (std::isnan(now)) return now;
  value_ = is_started_ ? now + (value_ - now) * elementary::exp(-dt_s / time_constant_s_) : now;
  is_started_ = true;
  return value_;
}

std::vector<LateChannel> LateChannel::all() {
  std::vector<LateChannel> channels;
  for (const int lag_ms : kLags_ms) channels.push_back(velocity(lag_ms));
  for (const int time_ms : kSettling_ms) channels.push_back(sign(time_ms));
  return channels;
}

std::optional<LateChannel> LateChannel::of(std::string_view name) {
  for (const bool settles : {false, true}) {
    const std::string_view stem = settles ? kSettles : kLate;
    if (!name.starts_with(stem)) continue;
    const std::string_view digits = name.substr(stem.size());
    int late_ms = 0;
    const auto [stop, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), late_ms);
    if (error != std::errc() || stop != digits.data() + digits.size() || late_ms <= 0) continue;
    return LateChannel(late_ms, settles);
  }
  return std::nullopt;
}

std::string LateChannel::name() const {
  return fmt::format("{}{}", settles_ ? kSettles : kLate, late_ms_);
}

std::string LateChannel::recipe() const {
  return settles_ ? fmt::format(
                        "the sign of v through a first-order filter of {} ms, from that in "
                        "the first row of a movement that does not follow on",
                        late_ms_)
                  : fmt::format(
                        "v as it was {} ms before, straight between rows; until then v in "
                        "the first row of a movement that does not follow on",
                        late_ms_);
}

std::string LateChannel::unit(const std::string& velocity_unit) const {
  return settles_ ? "-" : velocity_unit;
}

namespace {

// Whether a movement that begins in row i goes on where the one before it ended, a row or two at
// standstill left out: strokes of one motion.
bool follows_on(std::size_t i, std::span<const double> time) {
  constexpr double kOneStep = 0.5;  // at least, of the one before it: less is laid end to end
  constexpr double kFewSteps = 3.5;
  if (i < 2) return false;
  const double step = time[i] - time[i - 1];
  const double before = time[i - 1] - time[i - 2];
  return step >= kOneStep * before && step <= kFewSteps * before;
}

}  // namespace

std::vector<double> LateChannel::values(std::span<const double> v, std::span<const double> time,
                                        std::span<const int> movement, MovementOrder order) const {
  std::vector<double> late;
  auto memory_of_either = memory();
  std::visit(
      [&](auto& of) {
        for (std::size_t i = 0; i < v.size(); ++i) {
          const bool starts = i == 0 || (movement[i] != movement[i - 1] &&
                                         (order == MovementOrder::unknown || !follows_on(i, time)));
          if (starts) of.start_movement();
          late.push_back(of.next(v[i], starts ? 0 : rounded_step(time[i] - time[i - 1])));
        }
      },
      memory_of_either);
  return late;
}

std::variant<TimeLag, SettlingSign> LateChannel::memory() const {
  const double late_s = late_ms_ * 1e-3;
  if (settles_) return SettlingSign(late_s);
  return TimeLag(late_s);
}

std::string derived_channel_name(std::string_view signal) {
  return fmt::format("{}{}", signal, kDerived);
}

std::optional<DerivedSignal> derived_signal(std::string_view channel) {
  if (!channel.ends_with(kDerived)) return std::nullopt;
  const std::string signal(channel.substr(0, channel.size() - kDerived.size()));
  if (signal == "d") return DerivedSignal{signal, distance_recipe()};
  if (signal == kSeenDistance) return DerivedSignal{signal, seen_distance_recipe()};
  if (const auto late = LateChannel::of(signal)) return DerivedSignal{signal, late->recipe()};
  return std::nullopt;
}

bool is_distance(std::string_view name) { return name == "d" || name == kSeenDistance; }

std::string distance_recipe() {
  return "d grows by abs(q - q_before), or abs(v)*dt; at the first row after a change of v's sign "
         "it "
         "is 0.5*abs(v)*dt*abs(v)/(abs(v) + abs(v_before)), at a movement's first row 0";
}

std::string seen_distance_recipe() {
  return "d; as long as it can be until the first reversal of a movement that starts in motion, or "
         "goes on the way that the one before it ended";
}

std::vector<double> seen_distance(std::vector<double> distance, std::span<const char> seen) {
  double farthest = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != 0) farthest = std::max(farthest, distance[i]);
  }
  if (!(farthest > 0) || std::ranges::count(seen, 0) == 0) return {};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0) distance[i] = farthest;
  }
  return distance;
}

std::string c_history_code(std::string_view function, std::span<const std::string> arguments,
                           PathFrom from) {
  const bool by_position = from == PathFrom::position;
  std::vector<std::string> taken = {"v"};
  if (by_position) taken.emplace_back("q");
  for (const std::string& name : arguments) {
    if (!is_distance(name) && std::ranges::count(taken, name) == 0) taken.push_back(name);
  }
  std::string parameters;
  for (const std::string& name : taken) parameters += fmt::format("double {}, ", name);
  std::string distances;
  for (const std::string& name : arguments) {
    if (is_distance(name)) distances += fmt::format("  const double {} = h->d;\n", name);
  }
  constexpr std::string_view kCode = R"(
/* What {0} needs to know of the movement so far, for d: the distance since the velocity last
 * changed its sign. One a joint; begin each movement with {0}_start. */
typedef struct {{
  int started;
  double direction, v_before,{1} d;
}} {0}_history;

void {0}_start({0}_history *h) {{
  h->started = 0;
}}

/* Once a sample, in order. dt: seconds since the sample before. */
double {0}_step({0}_history *h, {2}double dt) {{
  const double now = (double)((v > 0.0) - (v < 0.0));
  if (!h->started) {{
    h->d = 0.0;
    h->direction = now;
    h->started = 1;
  }} else if (now != 0.0 && now != h->direction) {{
    /* The path from the zero crossing, the velocity taken to be linear in time. */
    const double part = fabs(v) / (fabs(v) + fabs(h->v_before));
    h->d = 0.5 * fabs(v) * part * dt;
    h->direction = now;
  }} else {{
    h->d += fabs({3});
  }}
  h->v_before = v;
{4}{6}  return {0}({5});
}}
)";
  return fmt::format(kCode, function, by_position ? " q_before," : "", parameters,
                     by_position ? "q - h->q_before" : "v * dt",
                     by_position ? "  h->q_before = q;\n" : "", fmt::join(arguments, ", "),
                     distances);
}

}  // namespace tribench::loop
