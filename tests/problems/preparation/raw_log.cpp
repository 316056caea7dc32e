// SPDX-License-Identifier: MIT
#include "tests/problems/preparation/raw_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/random.hpp"

namespace tribench::testing {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kInertia = 0.8;       // kg m^2
constexpr double kCoulomb = 5;         // N m
constexpr double kViscous = 8;         // N m s/rad
constexpr double kPresliding = 0.004;  // rad that the bristle gives before it slides (Dahl)
constexpr double kReach = 1.0;         // rad either way

// The next stroke: to the other side at a speed of its own, after a rest.
struct Stroke {
  double goal = 0;
  double speed = 0;
  double rest = 0;
};

Stroke draw(RandomStream& random, int number) {
  return {(number % 2 == 0 ? 1 : -1) * kReach * random.uniform(0.5, 1.0),
          0.06 * std::pow(20.0, random.uniform(0, 1)), random.uniform(0.2, 0.5)};
}

std::string number(double value, int digits, bool comma) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (comma) std::ranges::replace(text, '.', ',');
  return text;
}

}  // namespace

std::vector<RawSample> simulate(const RawLogPlan& plan) {
  RandomStream random = RandomStream(plan.seed).split("raw log");
  constexpr int kSteps = 10;  // of the integration in a sample
  const double h = plan.step / kSteps;
  std::vector<RawSample> samples;
  double q = 0;
  double v = 0;
  double z = 0;  // the bristle, from -1 to 1
  double filtered = 0;
  double noise = 0;
  int strokes = 0;
  Stroke stroke = draw(random, strokes);
  double resting = stroke.rest;
  bool moving = false;
  const auto count = static_cast<std::size_t>(plan.seconds / plan.step);
  for (std::size_t i = 0; i < count; ++i) {
    RawSample sample;
    sample.time = static_cast<double>(i) * plan.step;
    if (!moving && (resting -= plan.step) <= 0) {
      moving = true;
      ++strokes;
    }
    double a = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double left = stroke.goal - q;
      const double direction = left > 0 ? 1 : -1;
      // A trapezoid: as fast as the stroke is, or as can still be stopped.
      const double wanted =
          moving ? direction * std::min(stroke.speed, std::sqrt(2 * 3.0 * std::abs(left))) : 0.0;
      a = std::clamp((wanted - v) / 0.01, -6.0, 6.0);
      v += a * h;
      q += v * h;
      z += (v - std::abs(v) * z) * h / kPresliding;
      z = std::clamp(z, -1.0, 1.0);
      filtered += (v - filtered) * h / std::max(plan.velocity_filter, h);
    }
    if (moving && std::abs(stroke.goal - q) < 2e-4) {
      moving = false;
      stroke = draw(random, strokes);
      resting = stroke.rest;
    }
    sample.position = q;
    sample.velocity = v;
    sample.filtered_velocity = filtered;
    sample.acceleration = a;
    sample.gravity = plan.gravity * std::sin(q);
    const double coulomb = kCoulomb + plan.load * std::abs(sample.gravity) +
                           plan.stribeck * std::exp(-std::abs(v) / 0.1);
    noise = 0.8 * noise + plan.noise * 0.6 * random.normal();
    sample.torque = kInertia * a + sample.gravity + coulomb * z + kViscous * v +
                    plan.ripple * std::cos(200 * q + 0.4) + noise;
    sample.movement = moving ? strokes : 0;
    samples.push_back(sample);
  }
  return samples;
}

std::string clean_table(const std::vector<RawSample>& samples) {
  std::string text =
      "movement,time_s,position_rad,velocity_rad_s,acceleration_rad_s2,gravity_torque_Nm,"
      "motor_torque_Nm\n";
  for (const RawSample& s : samples) {
    if (s.movement == 0 || std::abs(s.velocity) < 0.02) continue;
    text += fmt::format("{},{:.6f},{:.9f},{:.9f},{:.6f},{:.6f},{:.6f}\n", s.movement, s.time,
                        s.position, s.velocity, s.acceleration, s.gravity, s.torque);
  }
  return text;
}

std::string raw_table(const std::vector<RawSample>& samples, const RawLogPlan& plan,
                      const RawTelling& telling) {
  const char separator = telling.decimal_comma ? ';' : ',';
  std::vector<std::pair<std::string, std::string>> columns = {
      {"time", "ms"}, {"position", telling.counts ? "counts" : "deg"}, {"current", "mA"}};
  if (telling.velocity) columns.emplace_back("velocity", "deg/s");
  if (telling.gravity) columns.emplace_back("gravity_torque", "N m");
  std::string text = "# recorded by the controller\n";
  for (const bool units : {false, true}) {
    if (units && !telling.units_row) continue;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (j > 0) text += separator;
      text += units ? columns[j].second
                    : columns[j].first +
                          (telling.units_row ? "" : fmt::format(" [{}]", columns[j].second));
    }
    text += '\n';
  }
  const double count = kTurn / std::pow(2.0, plan.encoder_bits);
  constexpr double kDegree = 180 / std::numbers::pi;
  const bool comma = telling.decimal_comma;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const RawSample& s = samples[i];
    if (telling.losses && i % 3000 > 2950) continue;
    const double counts = std::floor(s.position / count);
    std::string row = number(1e3 * s.time, 1, comma);
    row += separator +
           (telling.counts ? number(counts, 0, comma) : number(counts * count * kDegree, 5, comma));
    row += separator + number(1e3 * s.torque / plan.torque_constant, 1, comma);
    if (telling.velocity) row += separator + number(s.filtered_velocity * kDegree, 3, comma);
    if (telling.gravity) row += separator + number(s.gravity, 4, comma);
    text += row + '\n';
  }
  return text;
}

}  // namespace tribench::testing
