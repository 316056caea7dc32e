// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/joint_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::forward {
namespace {

constexpr double kSafety = 0.9;
constexpr double kMostGrowth = 5;
constexpr double kLeastShrink = 0.2;
constexpr std::uint64_t kMostStepsOfStretch = 100'000;
constexpr int kMostBisections = 60;
// Of a tolerance: a velocity that counts as 0, and one below which break-away does not count.
constexpr double kStandstill = 1e-3;

}  // namespace

std::string_view motion_status_name(MotionStatus status) {
  switch (status) {
    case MotionStatus::complete:
      return "complete";
    case MotionStatus::not_finite:
      return "not finite";
    case MotionStatus::left_range:
      return "left the range";
    case MotionStatus::too_many_steps:
      return "too many steps";
  }
  return "";
}

JointInstant JointIntegrator::instant(double since_begin_s, double since_commit, double position,
                                      double velocity) const {
  JointInstant at;
  at.time = begin_ + since_begin_s;
  at.position = position;
  at.velocity = velocity;
  at.since_commit = since_commit;
  (*around_)(since_begin_s, at);
  return at;
}

double JointIntegrator::acceleration(double since_begin_s, double since_commit, double position,
                                     double velocity, int direction) {
  const JointInstant at = instant(since_begin_s, since_commit, position, velocity);
  const double a = equation_.acceleration(at, direction);
  if (!std::isfinite(a)) has_failed_ = true;
  return a;
}

void JointIntegrator::begin(double time, double position, double velocity,
                            const Surroundings& around) {
  around_ = &around;
  begin_ = time;
  past_ = 0;
  next_step_s_ = 0;
  has_failed_ = false;
  const bool rests = std::abs(velocity) <= tolerances_.velocity;
  state_ = {position, rests ? 0 : velocity, 0};
  equation_.begin(instant(0, 0, position, state_.velocity));
  state_.direction = rests ? starting_direction(0, 0, 0) : velocity > 0 ? 1 : -1;
}

int JointIntegrator::starting_direction(double since_begin_s, double since_commit, int from) {
  const double q = state_.position;
  const double least = kStandstill * tolerances_.velocity;  // m/s gained in a second
  const bool forwards = acceleration(since_begin_s, since_commit, q, 0, 1) > least;
  const bool backwards = acceleration(since_begin_s, since_commit, q, 0, -1) < -least;
  if (forwards && backwards) {
    ++counts_.pushed;
    return from != 0 ? -from : 1;  // it came to 0 from `from`: on through it
  }
  return forwards ? 1 : backwards ? -1 : 0;
}

JointIntegrator::Step JointIntegrator::try_step(double h, double a0) {
  const int s = state_.direction;
  const double q = state_.position;
  const double v = state_.velocity;
  const double v2 = v + h / 2 * a0;
  const double a2 = acceleration(past_ + h / 2, h / 2, q + h / 2 * v, v2, s);
  const double v3 = v + 3 * h / 4 * a2;
  const double a3 = acceleration(past_ + 3 * h / 4, 3 * h / 4, q + 3 * h / 4 * v2, v3, s);
  Step to;
  to.position = q + h * (2 * v + 3 * v2 + 4 * v3) / 9;
  to.velocity = v + h * (2 * a0 + 3 * a2 + 4 * a3) / 9;
  to.acceleration = acceleration(past_ + h, h, to.position, to.velocity, s);
  const double of_q = h * (-5 * v / 72 + v2 / 12 + v3 / 9 - to.velocity / 8);
  const double of_v = h * (-5 * a0 / 72 + a2 / 12 + a3 / 9 - to.acceleration / 8);
  to.error = std::max(std::abs(of_q) / tolerances_.position, std::abs(of_v) / tolerances_.velocity);
  return to;
}

void JointIntegrator::take(double h, const Step& step) {
  past_ += h;
  state_.position = step.position;
  state_.velocity = step.velocity;
  equation_.commit(instant(past_, h, state_.position, state_.velocity));
  ++counts_.steps;
}

// Where along the step the velocity passes 0, as a share of it; 2 where it does not. Between the
// ends it is the cubic that they determine.
double JointIntegrator::passes_standstill(double h, double a0, const Step& step) const {
  const int s = state_.direction;
  if (s * step.velocity < 0) return 1;
  const double v0 = s * state_.velocity;
  const double v1 = s * step.velocity;
  const double d0 = s * h * a0;
  const double d1 = s * h * step.acceleration;
  // v(x) = v0 + d0 x + c x^2 + e x^3
  const double c = 3 * (v1 - v0) - 2 * d0 - d1;
  const double e = 2 * (v0 - v1) + d0 + d1;
  const double discriminant = c * c - 3 * d0 * e;
  if (!(discriminant > 0) || e == 0) return 2;
  const double x = (-c + std::sqrt(discriminant)) / (3 * e);  // the minimum
  if (!(x > 0 && x < 1)) return 2;
  const double least = v0 + x * (d0 + x * (c + x * e));
  return least < -tolerances_.velocity ? x : 2;
}

// Shortens the step until it ends at the standstill, and takes it; false where no direction
// follows.
bool JointIntegrator::stop_within(double h, double a0) {
  const int s = state_.direction;
  double low = 0;
  double high = h;
  double v_low = s * state_.velocity;
  Step step = try_step(h, a0);
  double v_high = s * step.velocity;
  double at = h;
  int side = 0;
  for (int k = 0; k < kMostBisections && !has_failed_; ++k) {
    if (std::abs(s * step.velocity) <= kStandstill * tolerances_.velocity && k > 0) break;
    if (high - low <= 1e-15 * (past_ + h)) break;
    at = (low * v_high - high * v_low) / (v_high - v_low);  // regula falsi, Illinois
    if (!(at > low && at < high)) at = 0.5 * (low + high);
    step = try_step(at, a0);
    const double v = s * step.velocity;
    if (v < 0) {
      high = at;
      v_high = v;
      if (side == -1) v_low /= 2;
      side = -1;
    } else {
      low = at;
      v_low = v;
      if (side == 1) v_high /= 2;
      side = 1;
    }
  }
  if (has_failed_) return false;
  step.velocity = 0;
  take(at, step);
  ++counts_.standstills;
  state_.direction = starting_direction(past_, 0, s);
  return !has_failed_;
}

bool JointIntegrator::slide(double duration_s) {
  const double left = duration_s - past_;
  double h = std::min({left, tolerances_.longest_step_s, next_step_s_ > 0 ? next_step_s_ : left});
  const double a0 = acceleration(past_, 0, state_.position, state_.velocity, state_.direction);
  if (has_failed_) return false;
  if (state_.velocity == 0 && a0 * state_.direction <= 0) {  // it cannot start after all
    state_.direction = 0;
    return true;
  }
  const Step step = try_step(h, a0);
  if (has_failed_) return false;
  const double growth =
      step.error > 0 ? kSafety * elementary::pow(step.error, -1.0 / 3) : kMostGrowth;
  if (step.error > 1) {
    ++counts_.rejected;
    next_step_s_ = h * std::max(kLeastShrink, growth);
    return true;
  }
  const double passed = passes_standstill(h, a0, step);
  if (passed < 1) {  // and back: look closer
    ++counts_.rejected;
    next_step_s_ = h * passed;
    return true;
  }
  if (passed == 1) return stop_within(h, a0);
  take(h, step);
  // A step that the end of the stretch cut short says nothing about the next.
  const double proposed = h * std::min(kMostGrowth, growth);
  next_step_s_ = h < left ? proposed : std::max(next_step_s_, proposed);
  return true;
}

bool JointIntegrator::stick(double duration_s) {
  const double left = duration_s - past_;
  const double tried = std::min(left, tolerances_.longest_step_s);
  double stays = 0;
  double leaves = tried;
  int direction = starting_direction(past_ + tried, tried, 0);
  const bool sticks_on = direction == 0;
  for (int k = 0; k < kMostBisections && !sticks_on && leaves - stays > 1e-12 * tried; ++k) {
    const double middle = 0.5 * (stays + leaves);
    const int there = starting_direction(past_ + middle, middle, 0);
    if (there == 0) {
      stays = middle;
    } else {
      leaves = middle;
      direction = there;
    }
  }
  if (has_failed_) return false;
  take(leaves, {state_.position, 0, 0, 0});
  state_.direction = direction;
  if (direction != 0) next_step_s_ = 0;
  return true;
}

MotionStatus JointIntegrator::advance(double duration_s, const Surroundings& around, double reach) {
  around_ = &around;
  past_ = 0;
  const std::uint64_t first = counts_.steps + counts_.rejected;
  if (state_.velocity == 0) state_.direction = starting_direction(0, 0, 0);
  // Rounding may leave less of the stretch than a step can be told from.
  while (duration_s - past_ > 1e-13 * duration_s) {
    const bool fine = state_.direction == 0 ? stick(duration_s) : slide(duration_s);
    if (!fine || has_failed_) return MotionStatus::not_finite;
    if (std::abs(state_.position) > reach) return MotionStatus::left_range;
    if (counts_.steps + counts_.rejected - first > kMostStepsOfStretch) {
      return MotionStatus::too_many_steps;
    }
  }
  begin_ += duration_s;
  return MotionStatus::complete;
}

}  // namespace tribench::forward
