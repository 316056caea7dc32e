// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/joint_recording.hpp"

#include <array>
#include <cmath>

#include "foundation/elementary.hpp"
#include "problems/campaign_channels.hpp"

namespace tribench::simulation {
namespace {

constexpr double kWarming_degc = 16;  // at the usual speed, without end
constexpr double kUsualSpeed_rad_s = 0.25;
constexpr double kSensorStep_degc = 0.1;

}  // namespace

void Thermal::advance(double speed_rad_s, double dt_s) {
  const double goal = kCoolest_degc + kWarming_degc * speed_rad_s / kUsualSpeed_rad_s;
  oil_ += (goal - oil_) * -elementary::expm1(-dt_s / oil_s_);
  housing_ += (oil_ - housing_) * -elementary::expm1(-dt_s / housing_s_);
}

double Thermal::sensor_degc() const {
  return kSensorStep_degc * std::round(housing_ / kSensorStep_degc);
}

Thermal draw_thermal(double campaign_s, RandomStream random) {
  const double oil_s = campaign_s * random.uniform(0.1, 0.2);
  const double housing_s = campaign_s * random.uniform(0.04, 0.1);
  return {oil_s, housing_s};
}

Instant instant_of(const Movement& movement, double t_s) {
  Instant now;
  now.joint = movement.at(t_s);
  now.other = motion_of(movement.other, t_s);
  now.gravity_amplitude_nm = movement.gravity_nm;
  now.gravity_phase_rad = movement.gravity_phase_rad;
  now.gravity_nm =
      movement.gravity_nm * elementary::sin(now.joint.position_rad + movement.gravity_phase_rad);
  return now;
}

void append_row(Dataset& data, int movement, double time_s, const Instant& now,
                double sensor_degc) {
  append_campaign_row(data, movement,
                      {.time_s = time_s,
                       .position_rad = now.joint.position_rad,
                       .velocity_rad_s = now.joint.velocity_rad_s,
                       .acceleration_rad_s2 = now.joint.acceleration_rad_s2,
                       .gravity_nm = now.gravity_nm,
                       .temperature_degc = sensor_degc,
                       .other_velocity_rad_s = now.other.velocity_rad_s,
                       .other_acceleration_rad_s2 = now.other.acceleration_rad_s2});
}

std::vector<double> base_friction(std::span<const double> velocity, RandomStream random) {
  struct Branch {
    double coulomb_nm;
    double viscous_nms;
  };
  const std::array<Branch, 2> branches = {{{random.uniform(4, 9), random.uniform(8, 18)},
                                           {random.uniform(4, 9), random.uniform(8, 18)}}};
  std::vector<double> friction;
  for (const double v : velocity) {
    const Branch& branch = branches[v > 0 ? 0 : 1];
    friction.push_back((v > 0 ? 1 : -1) * branch.coulomb_nm + branch.viscous_nms * v);
  }
  return friction;
}

double root_mean_square(std::span<const double> values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace tribench::simulation
