// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/controlled_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "foundation/elementary.hpp"
#include "problems/joint_simulation/causes.hpp"
#include "problems/joint_simulation/motion.hpp"

namespace tribench::simulation {
namespace {

constexpr double kControllerStep_s = 0.001;
constexpr double kReachOfRun_rad = 1.5;
constexpr double kSlowestOfRun_rad_s = 0.04;
constexpr double kFastestOfRun_rad_s = 1.2;
constexpr double kMetresPerRadian = 0.2;
constexpr double kNewtonsPerNewtonMetre = 10;
constexpr double kOffset = 0.1;  // sd of the movements' offsets, in sd of the noise
constexpr double kSlowestTold_rad_s = 0.02;
constexpr double kHeld = 0.5;  // of Coulomb friction that stays when the joint has stopped

// The wanted velocity on the grid of kControllerStep_s, and where the brake is on.
struct Schedule {
  std::vector<double> velocity;
  std::vector<char> braked;
  double position = 0;  // at its end

  void add(double velocity_rad_s) {
    velocity.push_back(velocity_rad_s);
    braked.push_back(0);
    position += velocity_rad_s * kControllerStep_s;
  }
};

double draw_run_speed(RandomStream& random) {
  return kSlowestOfRun_rad_s *
         elementary::pow(kFastestOfRun_rad_s / kSlowestOfRun_rad_s, random.uniform());
}

// A stroke to the other side or some there and back without a rest.
void add_strokes(Schedule& schedule, RandomStream& random) {
  Movement movement(schedule.position);
  const std::uint64_t strokes = random.chance(0.3) ? 2 + random.below(4) : 1;
  for (std::uint64_t k = 0; k < strokes; ++k) {
    const double speed = draw_run_speed(random);
    const double side = movement.end_rad() > 0 ? -1 : 1;
    const double room = kReachOfRun_rad - side * movement.end_rad();
    const double length = std::clamp(speed * random.uniform(1, 4), 0.1, room);
    movement.add_stroke(movement.end_rad() + side * length, speed, random.uniform(1, 6));
  }
  for (double t = 0; t < movement.duration_s(); t += kControllerStep_s) {
    schedule.add(movement.at(t).velocity_rad_s);
  }
}

// A sum of two sines that fades in and out.
void add_sines(Schedule& schedule, RandomStream& random) {
  const double duration = random.uniform(6, 14);
  std::array<Sine, 2> sines;
  for (Sine& sine : sines) {
    const double rate = random.uniform(0.8, 4);
    sine = {draw_run_speed(random) * 0.6 / rate, rate, random.uniform(0, 2 * std::numbers::pi)};
  }
  for (double t = 0; t < duration; t += kControllerStep_s) {
    const double fade = elementary::sin(std::numbers::pi * t / duration);
    double velocity = 0;
    for (const Sine& sine : sines) velocity += motion_of(sine, t).velocity_rad_s;
    schedule.add(fade * velocity);
  }
}

void add_rest(Schedule& schedule, RandomStream& random) {
  const bool brake = random.chance(0.15);
  const double duration = brake ? random.uniform(2, 5) : random.uniform(0.2, 0.8);
  for (double t = 0; t < duration; t += kControllerStep_s) {
    schedule.add(0);
    schedule.braked.back() = brake && t > 0.4 && t < duration - 0.2 ? 1 : 0;
  }
}

Schedule make_schedule(double seconds, RandomStream random) {
  Schedule schedule;
  add_rest(schedule, random);
  while (static_cast<double>(schedule.velocity.size()) * kControllerStep_s < seconds) {
    if (random.chance(0.2) && std::abs(schedule.position) < 0.7) {
      add_sines(schedule, random);
    } else {
      add_strokes(schedule, random);
    }
    add_rest(schedule, random);
  }
  return schedule;
}

// Jerk is limited by a mean over the last `width` steps, as controllers do it.
std::vector<MotionState> motion_along(const Schedule& schedule, std::size_t width) {
  std::vector<MotionState> motion;
  const auto w = static_cast<double>(width);
  double sum = 0;
  MotionState now;
  for (std::size_t i = 0; i < schedule.velocity.size(); ++i) {
    const double leaving = i >= width ? schedule.velocity[i - width] : 0;
    sum += schedule.velocity[i] - leaving;
    const bool rests = std::abs(schedule.velocity[i]) == 0 && std::abs(sum) < 1e-9;
    if (rests) sum = 0;
    const double before = now.velocity_rad_s;
    now.velocity_rad_s = sum / w;
    now.acceleration_rad_s2 =
        rests ? 0 : (schedule.velocity[i] - leaving) / (w * kControllerStep_s);
    now.position_rad += 0.5 * (before + now.velocity_rad_s) * kControllerStep_s;
    motion.push_back(now);
  }
  return motion;
}

// What is drawn for a run.
struct Joint {
  explicit Joint(RandomStream random, bool has_gravity)
      : inertia(random.uniform(0.5, 3)),
        gravity_nm(has_gravity ? random.uniform(8, 35) : 0),
        gravity_phase_rad(random.uniform(-0.6, 0.6)),
        presliding_rad(2e-5 * elementary::pow(5.0, random.uniform())),
        coulomb_nm{random.uniform(4, 8), random.uniform(4, 8)},
        viscous_nms{random.uniform(6, 14), random.uniform(6, 14)},
        noise_sd(random.uniform(0.1, 0.3)),
        noise_s(random.uniform(0.001, 0.006)) {}
  double inertia;
  double gravity_nm;
  double gravity_phase_rad;
  double presliding_rad;
  std::array<double, 2> coulomb_nm;  // forwards, backwards
  std::array<double, 2> viscous_nms;
  double noise_sd;
  double noise_s;
};

struct Torques {
  double gravity = 0;
  double base = 0;
  double effect = 0;
};

// Integrates the friction along the motion; one entry a step.
std::vector<Torques> torques_along(const std::vector<MotionState>& motion, const Joint& joint,
                                   const Response& response) {
  std::vector<Torques> torques;
  double bristle = 0;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    Instant now;
    now.part = static_cast<double>(i) / static_cast<double>(motion.size());
    now.joint = motion[i];
    now.gravity_amplitude_nm = joint.gravity_nm;
    now.gravity_phase_rad = joint.gravity_phase_rad;
    now.gravity_nm =
        joint.gravity_nm * elementary::sin(motion[i].position_rad + joint.gravity_phase_rad);
    const double v = motion[i].velocity_rad_s;
    if (v == 0) {
      bristle += (kHeld * (bristle > 0 ? 1 : -1) - bristle) * 0.01;
    } else {
      bristle =
          now.sign() + (bristle - now.sign()) *
                           elementary::exp(-std::abs(v) * kControllerStep_s / joint.presliding_rad);
    }
    const std::size_t side = bristle > 0 ? 0 : 1;
    torques.push_back({now.gravity_nm,
                       joint.coulomb_nm[side] * bristle + joint.viscous_nms[v > 0 ? 0 : 1] * v,
                       response ? response(now, kControllerStep_s) : 0});
  }
  return torques;
}

struct Columns {
  std::vector<double> time, position, velocity, acceleration, gravity, torque, effect;
};

std::vector<Channel> channels_of(Columns columns, bool linear) {
  const std::string length = linear ? "m" : "rad";
  const std::string force = linear ? "N" : "N m";
  return {{"time_s", "s", Role::time, std::move(columns.time)},
          {"position", length, Role::position, std::move(columns.position)},
          {"velocity", length + "/s", Role::velocity, std::move(columns.velocity)},
          {"acceleration", length + "/s^2", Role::acceleration, std::move(columns.acceleration)},
          {"gravity_torque", force, Role::gravity_torque, std::move(columns.gravity)},
          {"motor_torque", force, Role::motor_torque, std::move(columns.torque)}};
}

// The samples that a controller at the plan's rate takes, without what is planted.
Columns sample(const ControlledRunPlan& plan, const Joint& joint, const Schedule& schedule,
               const std::vector<MotionState>& motion, const std::vector<Torques>& torques,
               RandomStream noise, std::vector<int>& move) {
  const double kept = elementary::exp(-kControllerStep_s / joint.noise_s);
  const auto stride = static_cast<std::size_t>(std::lround(1 / (kControllerStep_s * plan.rate_hz)));
  Columns columns;
  double coloured = joint.noise_sd * noise.normal();
  double offset = 0;
  int number = -1;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    coloured = kept * coloured + std::sqrt(1 - kept * kept) * joint.noise_sd * noise.normal();
    const bool moves = motion[i].velocity_rad_s != 0;
    if (moves && (i == 0 || motion[i - 1].velocity_rad_s == 0)) {
      ++number;
      offset = kOffset * joint.noise_sd * noise.normal();
    }
    if (i % stride != 0) continue;
    const bool braked = schedule.braked[i] != 0 && !moves;
    const double driven =
        torques[i].gravity + torques[i].base + joint.inertia * motion[i].acceleration_rad_s2;
    columns.time.push_back(static_cast<double>(i) * kControllerStep_s);
    columns.position.push_back(motion[i].position_rad);
    columns.velocity.push_back(motion[i].velocity_rad_s);
    columns.acceleration.push_back(motion[i].acceleration_rad_s2);
    columns.gravity.push_back(torques[i].gravity);
    columns.torque.push_back(coloured + (braked ? 0 : driven + offset));
    columns.effect.push_back(moves ? torques[i].effect : 0);
    move.push_back(moves ? number : -1);
  }
  return columns;
}

void plant(const ControlledRunPlan& plan, const Cause& cause, Columns& columns,
           ControlledRun& run) {
  double squares = 0;
  double rows = 0;
  for (std::size_t i = 0; i < run.move.size(); ++i) {
    if (run.move[i] < 0) continue;
    squares += columns.effect[i] * columns.effect[i];
    ++rows;
  }
  PlantedEffect effect{
      std::string(cause.name),  plan.scale, 0, cause.names, cause.beside, cause.lives_in,
      std::move(columns.effect)};
  effect.beside.emplace_back("hysteresis");
  effect.coefficient = squares > 0 ? plan.scale * run.noise_sd / std::sqrt(squares / rows) : 0;
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    effect.values[i] *= effect.coefficient;
    columns.torque[i] += effect.values[i];
  }
  run.effects.push_back(std::move(effect));
}

// The same machine as a slide: radians become metres, newton metres newtons.
void make_linear(Columns& columns, ControlledRun& run) {
  for (auto* lengths : {&columns.position, &columns.velocity, &columns.acceleration}) {
    for (double& value : *lengths) value *= kMetresPerRadian;
  }
  for (double& value : columns.torque) value *= kNewtonsPerNewtonMetre;
  for (PlantedEffect& effect : run.effects) {
    for (double& value : effect.values) value *= kNewtonsPerNewtonMetre;
  }
  run.noise_sd *= kNewtonsPerNewtonMetre;
  run.inertia *= kNewtonsPerNewtonMetre / kMetresPerRadian;
}

}  // namespace

ControlledRun run_under_control(const ControlledRunPlan& plan, std::uint64_t seed) {
  const RandomStream random = RandomStream(key_of("controlled_run")).split(seed);
  const Cause* cause = plan.cause.empty() ? nullptr : &find_cause(plan.cause);
  const Joint joint(random.split("joint"), plan.gravity && !plan.linear);
  const Schedule schedule = make_schedule(plan.seconds, random.split("schedule"));
  RandomStream jerk = random.split("jerk");
  const std::vector<MotionState> motion = motion_along(schedule, 20 + jerk.below(60));
  const std::vector<Torques> torques = torques_along(
      motion, joint, cause != nullptr ? cause->start(random.split("cause")) : Response());
  ControlledRun run;
  run.noise_sd = joint.noise_sd;
  run.inertia = joint.inertia;
  Columns columns = sample(plan, joint, schedule, motion, torques, random.split("noise"), run.move);
  if (cause != nullptr) plant(plan, *cause, columns, run);
  if (plan.linear) make_linear(columns, run);
  run.data.name = "controlled run";
  run.data.movement_names = {"run"};
  run.data.movement.assign(run.move.size(), 0);
  run.data.channels = channels_of(std::move(columns), plan.linear);
  return run;
}

Dataset ControlledRun::clean() const {
  Dataset out;
  out.name = data.name;
  const std::vector<double>& v = data.find(Role::velocity)->values;
  const bool linear = data.find(Role::velocity)->unit == "m/s";
  const double slowest = kSlowestTold_rad_s * (linear ? kMetresPerRadian : 1);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (move[i] < 0 || std::abs(v[i]) < slowest) continue;
    rows.push_back(i);
    out.movement.push_back(move[i]);
    while (out.movement_names.size() <= static_cast<std::size_t>(move[i])) {
      out.movement_names.push_back(fmt::format("move {}", out.movement_names.size() + 1));
    }
  }
  for (const Channel& channel : data.channels) {
    Channel kept{channel.name, channel.unit, channel.role, {}};
    for (const std::size_t i : rows) kept.values.push_back(channel.values[i]);
    out.channels.push_back(std::move(kept));
  }
  Channel& friction = out.channels.back();
  const std::vector<double>& a = out.find(Role::acceleration)->values;
  const std::vector<double>& g = out.find(Role::gravity_torque)->values;
  for (std::size_t i = 0; i < rows.size(); ++i) friction.values[i] -= inertia * a[i] + g[i];
  friction.name = "friction_torque";
  friction.role = Role::friction_torque;
  return out;
}

}  // namespace tribench::simulation
