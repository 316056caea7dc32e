// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/simulated_campaign.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "foundation/elementary.hpp"

namespace tribench::simulation {
namespace {

constexpr double kStep_s = 0.004;
constexpr double kRows = 5500;        // about so many are recorded
constexpr double kWarming_degc = 16;  // at the usual speed, without end
constexpr double kUsualSpeed_rad_s = 0.25;
constexpr double kOffset = 0.15;  // sd of the movements' offsets, in sd of the rows' noise
constexpr double kSensorStep_degc = 0.1;

double root_mean_square(std::span<const double> values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

// Motion warms the lubricant, the lubricant warms the housing with its sensor.
class Thermal {
 public:
  Thermal(double campaign_s, RandomStream random)
      : oil_s_(campaign_s * random.uniform(0.1, 0.2)),
        housing_s_(campaign_s * random.uniform(0.04, 0.1)) {}
  void advance(double speed_rad_s, double dt_s) {
    const double goal = kCoolest_degc + kWarming_degc * speed_rad_s / kUsualSpeed_rad_s;
    oil_ += (goal - oil_) * -elementary::expm1(-dt_s / oil_s_);
    housing_ += (oil_ - housing_) * -elementary::expm1(-dt_s / housing_s_);
  }
  double oil_degc() const { return oil_; }
  double sensor_degc() const { return kSensorStep_degc * std::round(housing_ / kSensorStep_degc); }

 private:
  double oil_s_;
  double housing_s_;
  double oil_ = kCoolest_degc;
  double housing_ = kCoolest_degc;
};

Dataset blank_dataset(const SimulatedCase& wanted) {
  Dataset data;
  data.name = fmt::format("simulated {}", design_name(wanted.design));
  data.channels = {{"time_s", "s", Role::time, {}},
                   {"position_rad", "rad", Role::position, {}},
                   {"velocity_rad_s", "rad/s", Role::velocity, {}},
                   {"acceleration_rad_s2", "rad/s^2", Role::acceleration, {}},
                   {"gravity_torque_Nm", "N m", Role::gravity_torque, {}},
                   {"temperature_degC", "degC", Role::temperature, {}},
                   {"other_velocity_rad_s", "rad/s", Role::other_velocity, {}},
                   {"other_acceleration_rad_s2", "rad/s^2", Role::other_acceleration, {}}};
  return data;
}

void record(Dataset& data, int movement, double time_s, const Instant& now, double sensor_degc) {
  const std::array row = {time_s,
                          now.joint.position_rad,
                          now.joint.velocity_rad_s,
                          now.joint.acceleration_rad_s2,
                          now.gravity_nm,
                          sensor_degc,
                          now.other.velocity_rad_s,
                          now.other.acceleration_rad_s2};
  for (std::size_t c = 0; c < row.size(); ++c) data.channels[c].values.push_back(row[c]);
  data.movement.push_back(movement);
}

// Half way through the joint stands still long enough to cool down, so that time and temperature
// are not the same.
double pause_after(std::size_t movement, std::size_t movements, double pause_s, double moving_s) {
  return movement + 1 == movements / 2 ? pause_s + 0.25 * moving_s : pause_s;
}

// Records the campaign and, row by row, the response.
Dataset run_campaign(const SimulatedCase& wanted, const std::vector<Movement>& movements,
                     const Response& response, RandomStream random, std::vector<double>& values) {
  Dataset data = blank_dataset(wanted);
  double moving_s = 0;
  for (const Movement& movement : movements) moving_s += movement.duration_s();
  double campaign_s = 0;
  for (std::size_t m = 0; m < movements.size(); ++m) {
    campaign_s += movements[m].duration_s() +
                  pause_after(m, movements.size(), movements[m].pause_s, moving_s);
  }
  const auto stride =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(moving_s / (kRows * kStep_s))));
  Thermal thermal(campaign_s, random.split("thermal"));
  double start_s = 0;
  for (std::size_t m = 0; m < movements.size(); ++m) {
    const Movement& movement = movements[m];
    data.movement_names.push_back(fmt::format("move {}", m + 1));
    const auto steps = static_cast<std::size_t>(movement.duration_s() / kStep_s);
    for (std::size_t i = 0; i <= steps; ++i) {
      const double t_s = static_cast<double>(i) * kStep_s;
      Instant now;
      now.part = (start_s + t_s) / campaign_s;
      now.joint = movement.at(t_s);
      now.other = motion_of(movement.other, t_s);
      now.gravity_amplitude_nm = movement.gravity_nm;
      now.gravity_phase_rad = movement.gravity_phase_rad;
      now.gravity_nm = movement.gravity_nm *
                       elementary::sin(now.joint.position_rad + movement.gravity_phase_rad);
      thermal.advance(std::abs(now.joint.velocity_rad_s), kStep_s);
      now.oil_degc = thermal.oil_degc();
      const double value = response ? response(now, kStep_s) : 0;
      if (i % stride != 0 || now.sign() == 0) continue;
      record(data, static_cast<int>(m), start_s + t_s, now, thermal.sensor_degc());
      values.push_back(value);
    }
    const double pause_s = pause_after(m, movements.size(), movement.pause_s, moving_s);
    thermal.advance(0, pause_s);
    start_s += movement.duration_s() + pause_s;
  }
  return data;
}

std::vector<double> base_friction(const Dataset& data, RandomStream random) {
  struct Branch {
    double coulomb_nm;
    double viscous_nms;
  };
  const std::array<Branch, 2> branches = {{{random.uniform(4, 9), random.uniform(8, 18)},
                                           {random.uniform(4, 9), random.uniform(8, 18)}}};
  std::vector<double> friction;
  for (const double v : data.find(Role::velocity)->values) {
    const Branch& branch = branches[v > 0 ? 0 : 1];
    friction.push_back((v > 0 ? 1 : -1) * branch.coulomb_nm + branch.viscous_nms * v);
  }
  return friction;
}

// Sets noise and noise_sd; quantised torques are rounded once the rest is there.
void add_noise(const SimulatedCase& wanted, const Dataset& data, RandomStream random,
               PlantedTruth& truth) {
  const double sd_nm = random.uniform(0.15, 0.5);
  const std::span<const double> velocity = data.find(Role::velocity)->values;
  for (std::size_t begin = 0; begin < data.rows();) {
    std::size_t end = begin;
    while (end < data.rows() && data.movement[end] == data.movement[begin]) ++end;
    const RandomStream own = random.split(static_cast<std::uint64_t>(data.movement[begin]));
    for (const double value :
         movement_noise(wanted.noise, velocity.subspan(begin, end - begin), own)) {
      truth.noise.push_back(sd_nm * value);
    }
    begin = end;
  }
  truth.noise_sd = root_mean_square(truth.noise);
  for (std::size_t i = 0; i < data.rows(); ++i) {
    RandomStream offset =
        random.split("offset").split(static_cast<std::uint64_t>(data.movement[i]));
    truth.noise[i] += kOffset * sd_nm * offset.normal();
  }
}

void quantise(double step_nm, PlantedTruth& truth) {
  const std::vector<double> clean = truth.noise_free();
  for (std::size_t i = 0; i < clean.size(); ++i) {
    truth.noise[i] = step_nm * std::round((clean[i] + truth.noise[i]) / step_nm) - clean[i];
  }
}

}  // namespace

PlantedData simulate(const SimulatedCase& wanted, std::uint64_t seed) {
  const RandomStream random = RandomStream(key_of("joint_simulation")).split(seed);
  const Cause* cause = wanted.cause.empty() ? nullptr : &find_cause(wanted.cause);
  const Response response =
      cause != nullptr ? cause->start(random.split("cause").split(wanted.cause)) : Response();
  const std::vector<Movement> movements = make_movements(wanted.design, random.split("motion"));
  std::vector<double> values;
  PlantedData run;
  run.data = run_campaign(wanted, movements, response, random.split("campaign"), values);
  run.truth.base = base_friction(run.data, random.split("base"));
  add_noise(wanted, run.data, random.split("noise"), run.truth);
  if (cause != nullptr) {
    PlantedEffect effect{std::string(cause->name), wanted.scale,     0, cause->names, cause->beside,
                         cause->lives_in,          std::move(values)};
    const double size = root_mean_square(effect.values);
    effect.coefficient = size > 0 ? wanted.scale * run.truth.noise_sd / size : 0;
    for (double& value : effect.values) value *= effect.coefficient;
    run.truth.effects.push_back(std::move(effect));
  }
  const double step = quantisation_step(wanted.noise) * run.truth.noise_sd;
  if (step > 0) quantise(step, run.truth);
  Channel friction{"friction_torque_Nm", "N m", Role::friction_torque, run.truth.noise_free()};
  for (std::size_t i = 0; i < friction.values.size(); ++i) {
    friction.values[i] += run.truth.noise[i];
  }
  run.data.channels.push_back(std::move(friction));
  return run;
}

}  // namespace tribench::simulation
