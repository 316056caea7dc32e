// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/elementary.hpp"

namespace tribench::simulation {
namespace {

constexpr double kReach_rad = 1.9;  // the joint's range is [-1.9, 1.9]
constexpr double kSlowest_rad_s = 0.03;
constexpr double kFastest_rad_s = 0.8;
constexpr double kTwoPi = 2 * std::numbers::pi;

struct Layout {
  int movements;
  double sine_share;  // of movements that are sums of sines
  double sine_s;      // their duration
  double strokes_s;   // a movement of strokes takes about so long
  double pause_s;
};

Layout layout_of(Design design) {
  switch (design) {
    case Design::mixed:
      return {70, 0.4, 8, 8, 3};
    case Design::few_long:
      return {8, 0.5, 60, 60, 20};
    case Design::many_short:
      return {220, 0, 0, 1, 1};
    case Design::one_way:
      return {80, 0, 0, 5, 3};
  }
  return {};
}

// Slow and fast speeds are equally frequent on a logarithmic scale.
double draw_speed(RandomStream& random) {
  return kSlowest_rad_s * elementary::pow(kFastest_rad_s / kSlowest_rad_s, random.uniform());
}

Movement make_sines(double duration_s, RandomStream& random) {
  std::array<Sine, 3> sines;
  const double top_rad_s = random.uniform(0.15, 0.75);
  double reach = 0;
  for (Sine& sine : sines) {
    const double rate = random.uniform(0.4, 4.0);
    sine = {top_rad_s * random.uniform(0.1, 0.5) / rate, rate, random.uniform(0, kTwoPi)};
    reach += sine.amplitude_rad;
  }
  const double room = std::max(0.0, kReach_rad - reach);
  return {random.uniform(-room, room), sines, duration_s};
}

// There and back until the time is used up, one stroke at least.
Movement make_strokes(double duration_s, RandomStream& random) {
  Movement movement(random.uniform(-kReach_rad, kReach_rad));
  while (movement.duration_s() < duration_s) {
    const double speed = draw_speed(random);
    const bool forwards = movement.end_rad() < random.uniform(-kReach_rad, kReach_rad);
    const double room = kReach_rad - (forwards ? 1 : -1) * movement.end_rad();
    const double length = std::min(room, speed * duration_s * random.uniform(0.3, 0.9));
    if (length < 0.02) continue;
    movement.add_stroke(movement.end_rad() + (forwards ? length : -length), speed,
                        random.uniform(0.8, 4.0));
  }
  return movement;
}

Movement make_forward_stroke(double duration_s, RandomStream& random) {
  const double speed = draw_speed(random);
  const double length = std::min(2 * kReach_rad, speed * duration_s * random.uniform(0.6, 1.4));
  Movement movement(random.uniform(-kReach_rad, kReach_rad - length));
  movement.add_stroke(movement.end_rad() + length, speed, random.uniform(0.8, 4.0));
  return movement;
}

}  // namespace

std::string_view design_name(Design design) {
  constexpr std::array<std::string_view, 4> kNames = {"mixed", "few_long", "many_short", "one_way"};
  return kNames[static_cast<std::size_t>(design)];
}

void Movement::add_piece(double acceleration, double duration_s) {
  pieces_.push_back({duration_s_, {end_.position_rad, end_.velocity_rad_s, acceleration}});
  end_.position_rad += (end_.velocity_rad_s + acceleration * duration_s / 2) * duration_s;
  end_.velocity_rad_s += acceleration * duration_s;
  duration_s_ += duration_s;
}

void Movement::add_stroke(double target_rad, double speed_rad_s, double acceleration_rad_s2) {
  const double length = target_rad - end_.position_rad;
  const double direction = length < 0 ? -1 : 1;
  const double top = std::min(speed_rad_s, std::sqrt(std::abs(length) * acceleration_rad_s2));
  const double ramp_s = top / acceleration_rad_s2;
  add_piece(direction * acceleration_rad_s2, ramp_s);
  add_piece(0, std::abs(length) / top - ramp_s);
  add_piece(-direction * acceleration_rad_s2, ramp_s);
  end_ = {target_rad, 0, 0};
}

MotionState Movement::at(double t_s) const {
  if (pieces_.empty()) {
    MotionState sum{end_.position_rad, 0, 0};
    for (const Sine& sine : sines_) {
      const MotionState part = motion_of(sine, t_s);
      sum.position_rad += part.position_rad;
      sum.velocity_rad_s += part.velocity_rad_s;
      sum.acceleration_rad_s2 += part.acceleration_rad_s2;
    }
    return sum;
  }
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), t_s,
                                      [](double t, const Piece& p) { return t < p.begin_s; });
  const Piece& piece = *(after - 1);
  const double t = t_s - piece.begin_s;
  const auto& [q, v, a] = piece.state;
  return {q + (v + a * t / 2) * t, v + a * t, a};
}

MotionState motion_of(const Sine& sine, double t_s) {
  const double angle = sine.rate_rad_s * t_s + sine.phase_rad;
  const double position = sine.amplitude_rad * elementary::sin(angle);
  return {position, sine.amplitude_rad * sine.rate_rad_s * elementary::cos(angle),
          -sine.rate_rad_s * sine.rate_rad_s * position};
}

std::vector<Movement> make_movements(Design design, RandomStream random) {
  const Layout layout = layout_of(design);
  // Three poses of the arm behind the joint.
  std::array<std::array<double, 2>, 3> poses{};
  for (auto& [gravity_nm, phase_rad] : poses) {
    gravity_nm = random.uniform(12, 45);
    phase_rad = random.uniform(-0.6, 0.6);
  }
  std::vector<Movement> movements;
  for (int m = 0; m < layout.movements; ++m) {
    Movement movement = design == Design::one_way ? make_forward_stroke(layout.strokes_s, random)
                        : random.chance(layout.sine_share) ? make_sines(layout.sine_s, random)
                                                           : make_strokes(layout.strokes_s, random);
    const auto& [gravity_nm, phase_rad] = poses[random.below(poses.size())];
    movement.gravity_nm = gravity_nm;
    movement.gravity_phase_rad = phase_rad;
    if (random.chance(0.6)) {
      const double rate = random.uniform(0.4, 3.0);
      movement.other = {random.uniform(0.1, 0.6) / rate, rate, random.uniform(0, kTwoPi)};
    }
    movement.pause_s = layout.pause_s * random.uniform(0.5, 1.5);
    movements.push_back(std::move(movement));
  }
  return movements;
}

}  // namespace tribench::simulation
