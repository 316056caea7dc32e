// SPDX-License-Identifier: MIT
#include "tests/algorithms/diagnosis/planted_data.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tribench {
namespace {

constexpr double kTopSpeed = 0.68;
constexpr double kNoise = 0.30;

struct Row {
  int movement;
  double t, q, v, a, g, T, v2, a2, d;
};

double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

struct Builder {
  RandomStream random;
  std::vector<Row> rows;
  double clock = 0;

  double temperature(double progress) {
    const double warm = progress < 0.5 ? progress : progress - 0.5 + 0.12;
    return 24 + 16 * (1 - std::exp(-warm / 0.22));
  }

  void constant_velocity(int movement, double v, double progress) {
    const bool stretched = random.chance(0.5);
    const double duration = 4 / std::abs(v);
    std::vector<double> at(40);
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = (static_cast<double>(i) + random.uniform()) / 40 * duration;
    }
    for (const double time : at) {
      const double q = v > 0 ? -2 + v * time : 2 + v * time;
      const double g = stretched ? 42.4 * std::sin(q) : 25 * std::sin(q + 0.5);
      rows.push_back(
          {movement, clock + time, q, v, 0, g, temperature(progress), 0, 0, std::abs(v) * time});
    }
    clock += duration + 5;
  }

  void two_tone(int movement, double progress) {
    const double w1 = random.uniform(0.5, 1.6);
    const double w2 = w1 * random.uniform(1.5, 2.5);
    const double p1 = random.uniform(0, 6.28);
    const double p2 = random.uniform(0, 6.28);
    const double share = random.uniform(0.3, 0.7);
    const double peak = random.uniform(0.5, 0.98) * kTopSpeed;
    const bool moving = random.chance(0.6);
    const double w3 = random.uniform(0.6, 1.5);
    const bool stretched = random.chance(0.5);
    const auto velocity = [&](double t) {
      return peak * (share * std::cos(w1 * t + p1) + (1 - share) * std::cos(w2 * t + p2));
    };
    const auto position = [&](double t) {
      return peak * (share / w1 * std::sin(w1 * t + p1) + (1 - share) / w2 * std::sin(w2 * t + p2));
    };
    double distance = 0;
    double direction = 0;
    double before = position(0);
    const double centre = random.uniform(-1, 1);
    for (int i = 0; i < 1200; ++i) {
      const double t = 0.01 * i;
      const double v = velocity(t);
      if (sign(v) != direction) distance = 0;
      direction = sign(v);
      distance += std::abs(position(t) - before);
      before = position(t);
      if (i % 10 != 5) continue;
      const double a =
          -peak * (share * w1 * std::sin(w1 * t + p1) + (1 - share) * w2 * std::sin(w2 * t + p2));
      const double q = centre + position(t);
      const double g = stretched ? 42.4 * std::sin(q) : 25 * std::sin(q + 0.5);
      const double v2 = moving ? 0.6 * std::cos(w3 * t + p2) : 0;
      const double a2 = moving ? -0.6 * w3 * std::sin(w3 * t + p2) : 0;
      rows.push_back({movement, clock + t, q, v, a, g, temperature(progress), v2, a2, distance});
    }
    clock += 17;
  }
};

double planted_shape(const std::string& name, const Row& r, double duration) {
  const double s = sign(r.v);
  const double x = std::abs(r.v);
  if (name == "stribeck") return s * std::exp(-(x / 0.06) * (x / 0.06));
  if (name == "nonlinear_viscous") return s * std::pow(x, 4);
  if (name == "load_coulomb") return s * std::abs(r.g);
  if (name == "load_viscous") return r.v * std::abs(r.g);
  if (name == "power_quadrant_gain") return r.g;
  if (name == "power_quadrant_step") return std::tanh(r.g / 0.5);
  if (name == "payload") return std::sin(r.q + 0.7);
  if (name == "output_ripple") return std::cos(3 * r.q + 0.7);
  if (name == "gear_ripple") return std::cos(160 * r.q + 0.7);
  if (name == "temperature") return r.v * std::exp(-(r.T - 24) / 12);
  if (name == "drift") return s * r.t / duration;
  if (name == "hysteresis") return s * std::exp(-r.d / 0.05);
  if (name == "lag") return s * std::exp(-x / 0.12) * sign(r.v * r.a);
  if (name == "inertia") return r.a;
  if (name == "coupling") return r.v2;
  if (name == "v_bump") return s * std::exp(-0.5 * std::pow((x - 0.35) / 0.04, 2));
  if (name == "q_bump") return std::exp(-0.5 * std::pow((r.q - 0.6) / 0.12, 2));
  if (name == "tq_interaction") return std::sin(2.5 * r.q) * (r.T - 34) / 5;
  if (name == "oscillation") return s * std::sin(2 * std::numbers::pi * 3.5 * r.t / duration);
  return 0;
}

void plant(std::vector<double>& truth, const std::vector<Row>& rows, const Planting& planting,
           double direction) {
  std::vector<double> shape;
  double squares = 0;
  const double duration = rows.back().t;
  for (const Row& row : rows) {
    shape.push_back(planted_shape(planting.effect, row, duration));
    squares += shape.back() * shape.back();
  }
  const double rms = std::sqrt(squares / static_cast<double>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    truth[i] += direction * planting.size * kNoise * shape[i] / rms;
  }
}

// Student's t with `dof` degrees of freedom, scaled to unit variance.
double student(RandomStream& random, int dof) {
  double chi = 0;
  for (int i = 0; i < dof; ++i) {
    const double x = random.normal();
    chi += x * x;
  }
  return random.normal() / std::sqrt(chi / dof) * std::sqrt((dof - 2.0) / dof);
}

Channel channel(std::string name, std::string unit, Role role, const std::vector<Row>& rows,
                double Row::*member) {
  Channel out{std::move(name), std::move(unit), role, {}};
  for (const Row& row : rows) out.values.push_back(row.*member);
  return out;
}

}  // namespace

PlantedData make_planted(const PlantedOptions& options, std::uint64_t seed) {
  const RandomStream random(seed);
  Builder builder{random.split("motion"), {}, 0};
  std::vector<int> order(options.only_constant_velocity ? 90 : 108);
  std::iota(order.begin(), order.end(), 0);
  builder.random.shuffle(std::span(order));
  for (std::size_t m = 0; m < order.size(); ++m) {
    const double progress = static_cast<double>(m) / static_cast<double>(order.size());
    if (order[m] < 90) {
      const double v = 0.015 + (kTopSpeed - 0.015) * (order[m] / 2) / 44;
      builder.constant_velocity(static_cast<int>(m), order[m] % 2 == 0 ? v : -v, progress);
    } else {
      builder.two_tone(static_cast<int>(m), progress);
    }
  }
  const std::vector<Row>& rows = builder.rows;
  PlantedData out;
  for (const Row& r : rows) {
    out.truth.push_back(r.v > 0 ? 8.0 + 14.1 * r.v : -9.3 + 14.8 * r.v);
  }
  RandomStream signs = random.split("signs");
  for (const Planting& planting : options.effects) plant(out.truth, rows, planting, signs.sign());
  RandomStream noise = random.split("noise");
  const double rho = options.hard_noise ? 0.85 : 0.6;
  const int dof = options.hard_noise ? 4 : 5;
  const double spread = options.hard_noise ? 0.9 : 0.5;
  const double between = options.hard_noise ? 0.09 : 0.045;
  std::vector<double> y = out.truth;
  double state = 0;
  double offset = 0;
  double factor = 1;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || rows[i].movement != rows[i - 1].movement) {
      state = student(noise, dof);
      offset = between * noise.normal();
      factor = std::exp(0.2 * noise.normal());
    }
    state = rho * state + std::sqrt(1 - rho * rho) * student(noise, dof);
    const double speed = std::abs(rows[i].v) / kTopSpeed;
    y[i] += offset + kNoise * factor * (1 - spread / 2 + spread * speed) * state;
  }
  for (int k = 0; k < options.collisions; ++k) {
    const std::size_t at = noise.below(rows.size() - 12);
    const double size = options.collision_size * kNoise * noise.sign();
    for (std::size_t i = at; i < at + 8 && rows[i].movement == rows[at].movement; ++i) y[i] += size;
  }
  Dataset& data = out.data;
  data.name = "planted";
  data.channels = {channel("time_s", "s", Role::time, rows, &Row::t),
                   channel("position_rad", "rad", Role::position, rows, &Row::q),
                   channel("velocity_rad_s", "rad/s", Role::velocity, rows, &Row::v),
                   channel("gravity_torque_Nm", "N m", Role::gravity_torque, rows, &Row::g),
                   channel("temperature_degC", "degC", Role::temperature, rows, &Row::T),
                   channel("distance_since_reversal_rad", "rad", Role::none, rows, &Row::d),
                   {"friction_torque_Nm", "N m", Role::friction_torque, y}};
  if (!options.only_constant_velocity) {
    data.channels.push_back(
        channel("acceleration_rad_s2", "rad/s^2", Role::acceleration, rows, &Row::a));
    data.channels.push_back(
        channel("other_velocity_rad_s", "rad/s", Role::other_velocity, rows, &Row::v2));
    data.channels.push_back(
        channel("other_acceleration_rad_s2", "rad/s^2", Role::other_acceleration, rows, &Row::a2));
  }
  for (std::size_t m = 0; m < order.size(); ++m) data.movement_names.push_back(std::to_string(m));
  for (const Row& row : rows) data.movement.push_back(row.movement);
  return out;
}

}  // namespace tribench
