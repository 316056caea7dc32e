// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "foundation/error.hpp"
#include "problems/campaign_channels.hpp"
#include "problems/friction/planted_effects.hpp"
#include "problems/joint_simulation/world_motion.hpp"

namespace tribench::simulation {
namespace {

constexpr double kWorldStep_s = 0.004;
constexpr std::size_t kStride = 20;  // steps a row
constexpr int kUsualMovements = 40;  // over which an effect has its scale

struct Hidden {
  std::string name;
  std::vector<std::string> names;
  std::vector<std::string> beside;
  std::vector<Role> lives_in;
};

// A shape that no library has as a response without a memory.
Response response_of(const PlantedShape& shape) {
  return [at = shape.at](const Instant& now, double) {
    JointState x;
    x.position_rad = now.joint.position_rad;
    x.velocity_rad_s = now.joint.velocity_rad_s;
    x.acceleration_rad_s2 = now.joint.acceleration_rad_s2;
    x.gravity_nm = now.gravity_nm;
    x.temperature_degc = now.oil_degc;
    x.campaign_part = now.part;
    x.other_velocity_rad_s = now.other.velocity_rad_s;
    x.other_acceleration_rad_s2 = now.other.acceleration_rad_s2;
    return at(x);
  };
}

std::vector<Hidden> hidden_of(bool in_library) {
  std::vector<Hidden> all;
  for (const Cause& cause : causes()) {
    if (cause.names.empty() == in_library || !cause.in_worlds) continue;
    all.push_back({std::string(cause.name), cause.names, cause.beside, cause.lives_in});
  }
  if (in_library) return all;
  for (const PlantedShape& shape : planted_shapes()) {
    if (!shape.in_library) all.push_back({std::string(shape.family), {}, {}, shape.lives_in});
  }
  return all;
}

bool is_simulated(std::string_view name) {
  return std::ranges::count(causes(), name, &Cause::name) > 0;
}

WorldKind draw_kind(RandomStream random) {
  const double u = random.uniform();
  return u < 0.15   ? WorldKind::none
         : u < 0.6  ? WorldKind::single
         : u < 0.85 ? WorldKind::pair
                    : WorldKind::unknown;
}

NoiseKind draw_noise(WorldLevel level, RandomStream random) {
  using enum NoiseKind;
  constexpr std::array kMild = {gaussian, skewed, heteroscedastic, heavy_tailed};
  if (level == WorldLevel::easy) return gaussian;
  if (level == WorldLevel::medium) return kMild[random.below(kMild.size())];
  return kNoiseKinds[random.below(kNoiseKinds.size())];
}

double draw_scale(WorldLevel level, RandomStream& random) {
  const double least = smallest_effect(level);
  return random.uniform(least, 2 * least);
}

double rounded(double x, double step) { return step * std::round(x / step); }

MotionLimits draw_limits(RandomStream random) {
  MotionLimits limits;
  limits.lowest_rad = rounded(-random.uniform(1.2, 1.9), 0.1);
  limits.highest_rad = rounded(random.uniform(1.2, 1.9), 0.1);
  limits.speed_rad_s = rounded(random.uniform(0.5, 0.8), 0.05);
  limits.acceleration_rad_s2 = rounded(random.uniform(2, 4), 0.5);
  limits.gravity_nm = rounded(random.uniform(12, 45), 0.1);
  limits.gravity_phase_rad = rounded(random.uniform(-0.6, 0.6), 0.01);
  limits.torque_nm = rounded(30 + limits.gravity_nm * random.uniform(1.0, 1.6), 1);
  limits.temperature_rise_k = rounded(random.uniform(15, 40), 1);
  limits.ambient_degc = kCoolest_degc;
  limits.seconds = 600;
  limits.least_load_factor = 0.5;
  limits.greatest_load_factor = 1.5;
  limits.greatest_other_velocity_rad_s = 0.6;
  limits.longest_rest_s = 120;
  limits.rate_hz = 1 / (kWorldStep_s * static_cast<double>(kStride));
  limits.gear_ratio = kGearRatio;
  return limits;
}

std::vector<PlantedEffect> draw_effects(const WorldPlan& plan, WorldKind kind,
                                        RandomStream random) {
  std::vector<PlantedEffect> effects;
  if (kind == WorldKind::none) return effects;
  const std::vector<Hidden> pool = hidden_of(kind != WorldKind::unknown);
  const std::size_t wanted = kind == WorldKind::pair ? 2 : 1;
  while (effects.size() < wanted) {
    const Hidden& one = pool[random.below(pool.size())];
    // Two causes of one name could not be told apart by their names.
    const bool known = std::ranges::any_of(effects, [&](const PlantedEffect& other) {
      return std::ranges::any_of(one.names, [&](const std::string& name) {
        return std::ranges::count(other.names, name) + std::ranges::count(other.beside, name) > 0;
      });
    });
    if (known) continue;
    effects.push_back(
        {one.name, draw_scale(plan.level, random), 0, one.names, one.beside, one.lives_in, {}});
  }
  return effects;
}

}  // namespace

std::string_view world_kind_name(WorldKind kind) {
  constexpr std::array<std::string_view, 4> kNames = {"none", "single", "pair", "unknown"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string_view world_level_name(WorldLevel level) {
  constexpr std::array<std::string_view, 3> kNames = {"easy", "medium", "hard"};
  return kNames[static_cast<std::size_t>(level)];
}

double smallest_effect(WorldLevel level) {
  constexpr std::array kScales = {2.0, 1.0, 0.5};
  return kScales[static_cast<std::size_t>(level)];
}

World::World(const WorldPlan& plan)
    : random_(RandomStream(key_of("joint_simulation/world"))
                  .split(plan.seed)
                  .split(world_level_name(plan.level))) {
  limits_ = draw_limits(random_.split("limits"));
  truth_.plan = plan;
  truth_.kind = plan.kind.value_or(draw_kind(random_.split("kind")));
  truth_.noise = draw_noise(plan.level, random_.split("noise kind"));
  truth_.noise_sd_nm = random_.split("noise sd").uniform(0.15, 0.5);
  truth_.effects = draw_effects(plan, truth_.kind, random_.split("effects"));
  state_.thermal = draw_thermal(limits_.seconds, random_.split("thermal"));
  state_.responses = fresh_responses();
  calibrate();
}

std::vector<Response> World::fresh_responses() const {
  std::vector<Response> responses;
  for (const PlantedEffect& effect : truth_.effects) {
    responses.push_back(
        is_simulated(effect.family)
            ? find_cause(effect.family).start(random_.split("cause").split(effect.family))
            : response_of(find_planted_shape(effect.family)));
  }
  return responses;
}

// The coefficients that give each effect its scale over usual movements.
void World::calibrate() {
  if (truth_.effects.empty()) return;
  State state = state_;
  Dataset data = blank_campaign("usual movements");
  std::vector<std::vector<double>> values(truth_.effects.size());
  std::vector<Movement> usual = make_movements(Design::mixed, random_.split("usual movements"));
  usual.resize(kUsualMovements, usual.front());
  for (Movement& movement : usual) {
    movement.gravity_nm = limits_.gravity_nm;
    run(state, movement, &data, &values);
    state.thermal.advance(0, movement.pause_s);
    state.time_s += movement.pause_s;
    state.movements += 1;
  }
  for (std::size_t k = 0; k < truth_.effects.size(); ++k) {
    const double size = root_mean_square(values[k]);
    PlantedEffect& effect = truth_.effects[k];
    effect.coefficient = size > 0 ? effect.scale * truth_.noise_sd_nm / size : 0;
  }
}

void World::run(State& state, const Movement& movement, Dataset* data,
                std::vector<std::vector<double>>* values) const {
  const auto steps = static_cast<std::size_t>(movement.duration_s() / kWorldStep_s);
  for (std::size_t i = 0; i <= steps; ++i) {
    const double t_s = static_cast<double>(i) * kWorldStep_s;
    Instant now = instant_of(movement, t_s);
    now.part = (state.time_s + t_s) / limits_.seconds;
    state.thermal.advance(std::abs(now.joint.velocity_rad_s), kWorldStep_s);
    now.oil_degc = state.thermal.oil_degc();
    const bool recorded = data != nullptr && i % kStride == 0 && now.sign() != 0;
    for (std::size_t k = 0; k < state.responses.size(); ++k) {
      const double value = state.responses[k](now, kWorldStep_s);
      if (recorded) (*values)[k].push_back(value);
    }
    if (!recorded) continue;
    append_row(*data, static_cast<int>(state.movements), state.time_s + t_s, now,
               state.thermal.sensor_degc());
  }
  state.time_s += movement.duration_s();
  state.position_rad = movement.at(movement.duration_s()).position_rad;
}

std::vector<double> World::noise_of(std::size_t movement, const Dataset& data) const {
  const RandomStream own = random_.split("noise").split(movement);
  std::vector<double> noise =
      movement_noise(truth_.noise, data.find(Role::velocity)->values, own.split("rows"));
  RandomStream offset = own.split("offset");
  const double shift = kMovementOffset * offset.normal();
  for (double& value : noise) value = truth_.noise_sd_nm * (value + shift);
  return noise;
}

std::vector<double> World::friction_of(std::size_t movement, const Dataset& data,
                                       const std::vector<std::vector<double>>& effects,
                                       std::string_view place) const {
  std::vector<double> friction =
      base_friction(data.find(Role::velocity)->values, random_.split("base"));
  const std::vector<double> noise = noise_of(movement, data);
  const double step = quantisation_step(truth_.noise) * truth_.noise_sd_nm;
  const std::vector<double>& gravity = data.find(Role::gravity_torque)->values;
  for (std::size_t i = 0; i < friction.size(); ++i) {
    double& torque = friction[i];
    for (std::size_t k = 0; k < effects.size(); ++k) {
      torque += truth_.effects[k].coefficient * effects[k][i];
    }
    torque += noise[i];
    if (step > 0) torque = step * std::round(torque / step);
    if (const double motor = std::abs(torque + gravity[i]); motor > limits_.torque_nm) {
      throw_bad_input(
          fmt::format("the motor would need {:.1f} N m at {:.2f} rad", motor,
                      data.find(Role::position)->values[i]),
          place,
          fmt::format("{:g} N m at most: less load, slower, or another place", limits_.torque_nm));
    }
  }
  return friction;
}

Dataset World::execute(const PlannedMovement& wanted, std::string_view place) {
  if (const BrokenLimit limit = broken_limit(wanted, limits_); limit.broken()) {
    throw_bad_input(limit.what, place, limit.mend);
  }
  const double cost_s = seconds_of(wanted, state_.position_rad, limits_);
  if (state_.used_s + cost_s > limits_.seconds) {
    throw_bad_input(fmt::format("it takes {:.1f} s, {:.1f} of {:g} s of motion are left", cost_s,
                                limits_.seconds - state_.used_s, limits_.seconds),
                    place, "shorten it, or stop here");
  }
  State state = state_;
  state.thermal.advance(0, wanted.rest);
  state.time_s += wanted.rest;
  if (start_of(wanted) != state.position_rad) {
    Movement approach(state.position_rad);
    approach.add_stroke(start_of(wanted), kApproachSpeed * limits_.speed_rad_s,
                        limits_.acceleration_rad_s2);
    run(state, approach, nullptr, nullptr);
  }
  const Movement movement = motion_for(wanted, limits_);
  Dataset data = blank_campaign("world");
  std::vector<std::vector<double>> values(truth_.effects.size());
  run(state, movement, &data, &values);
  data.movement_names = {fmt::format("move {}", state.movements + 1)};
  std::ranges::fill(data.movement, 0);
  if (data.rows() == 0) {
    throw_bad_input("it is over before one row is recorded", place, "make it longer");
  }
  std::vector<double> friction = friction_of(state.movements, data, values, place);
  data.channels.push_back(
      {"friction_torque_Nm", "N m", Role::friction_torque, std::move(friction)});
  const std::vector<double>& sensor = data.find(Role::temperature)->values;
  const double rise = *std::ranges::max_element(sensor) - kCoolest_degc;
  if (rise > limits_.temperature_rise_k) {
    throw_bad_input(fmt::format("the housing would be {:.1f} K over the coolest", rise), place,
                    fmt::format("{:g} K at most: rest before it (rest_s), or move slower",
                                limits_.temperature_rise_k));
  }
  state.movements += 1;
  state.used_s += cost_s;
  state_ = std::move(state);
  return data;
}

}  // namespace tribench::simulation
