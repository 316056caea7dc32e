// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/simulated_campaign.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "problems/campaign_channels.hpp"
#include "problems/joint_simulation/joint_recording.hpp"

namespace tribench::simulation {
namespace {

constexpr double kStep_s = 0.004;
constexpr double kRows = 5500;  // about so many are recorded

// Half way through the joint stands still long enough to cool down, so that time and temperature
// are not the same.
double pause_after(std::size_t movement, std::size_t movements, double pause_s, double moving_s) {
  return movement + 1 == movements / 2 ? pause_s + 0.25 * moving_s : pause_s;
}

// Records the campaign and, row by row, the response.
Dataset run_campaign(const SimulatedCase& wanted, const std::vector<Movement>& movements,
                     const Response& response, RandomStream random, std::vector<double>& values) {
  Dataset data = blank_campaign(fmt::format("simulated {}", design_name(wanted.design)));
  double moving_s = 0;
  for (const Movement& movement : movements) moving_s += movement.duration_s();
  double campaign_s = 0;
  for (std::size_t m = 0; m < movements.size(); ++m) {
    campaign_s += movements[m].duration_s() +
                  pause_after(m, movements.size(), movements[m].pause_s, moving_s);
  }
  const auto stride =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(moving_s / (kRows * kStep_s))));
  Thermal thermal = draw_thermal(campaign_s, random.split("thermal"));
  double start_s = 0;
  for (std::size_t m = 0; m < movements.size(); ++m) {
    const Movement& movement = movements[m];
    data.movement_names.push_back(fmt::format("move {}", m + 1));
    const auto steps = static_cast<std::size_t>(movement.duration_s() / kStep_s);
    for (std::size_t i = 0; i <= steps; ++i) {
      const double t_s = static_cast<double>(i) * kStep_s;
      Instant now = instant_of(movement, t_s);
      now.part = (start_s + t_s) / campaign_s;
      now.movement = m;
      thermal.advance(std::abs(now.joint.velocity_rad_s), kStep_s);
      now.oil_degc = thermal.oil_degc();
      const double value = response ? response(now, kStep_s) : 0;
      if (i % stride != 0 || now.sign() == 0) continue;
      append_row(data, static_cast<int>(m), start_s + t_s, now, thermal.sensor_degc());
      values.push_back(value);
    }
    const double pause_s = pause_after(m, movements.size(), movement.pause_s, moving_s);
    thermal.advance(0, pause_s);
    start_s += movement.duration_s() + pause_s;
  }
  return data;
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
    truth.noise[i] += kMovementOffset * sd_nm * offset.normal();
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
  run.truth.base = base_friction(run.data.find(Role::velocity)->values, random.split("base"));
  add_noise(wanted, run.data, random.split("noise"), run.truth);
  if (cause != nullptr) {
    PlantedEffect effect{std::string(cause->name), wanted.scale,     0, cause->names, cause->beside,
                         cause->lives_in,          std::move(values)};
    const double size = root_mean_square(effect.values);
    effect.coefficient = size > 0 ? wanted.scale * run.truth.noise_sd / size : 0;
    for (double& value : effect.values) value *= effect.coefficient;
    if (cause->has_bristles) {
      const RandomStream own = random.split("cause").split(wanted.cause);
      effect.stiffness = effect.coefficient * relaxed_stiffness(cause->start(own));
    }
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
