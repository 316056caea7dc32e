// SPDX-License-Identifier: MIT
#include "problems/friction/planted_effects.hpp"

#include <fmt/format.h>

#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/sign.hpp"
#include "foundation/suggestion.hpp"
#include "problems/friction/law.hpp"

namespace tribench {
namespace {

double bump(double x, double centre, double width) {
  const double z = (x - centre) / width;
  return elementary::exp(-z * z);
}

double stribeck(const JointState& x) {
  return sign(x.velocity_rad_s) * bump(std::abs(x.velocity_rad_s), 0, 0.06);
}
double nonlinear_viscous(const JointState& x) {
  const double square = x.velocity_rad_s * x.velocity_rad_s;
  return sign(x.velocity_rad_s) * square * square;
}
double load_coulomb(const JointState& x) { return sign(x.velocity_rad_s) * std::abs(x.gravity_nm); }
double load_viscous(const JointState& x) { return x.velocity_rad_s * std::abs(x.gravity_nm); }
double quadrant_gain(const JointState& x) { return x.gravity_nm; }
double quadrant_step(const JointState& x) { return elementary::tanh(x.gravity_nm / 0.8); }
double payload(const JointState& x) {
  return elementary::sin(x.position_rad) + 0.3 * elementary::cos(x.position_rad);
}
double output_ripple(const JointState& x) { return elementary::cos(3 * x.position_rad + 0.7); }
double gear_ripple(const JointState& x) { return elementary::cos(160 * x.position_rad + 0.7); }
double temperature(const JointState& x) {
  return x.velocity_rad_s * elementary::exp(-(x.temperature_degc - 24) / 12);
}
double drift(const JointState& x) { return sign(x.velocity_rad_s) * x.campaign_part; }
double hysteresis(const JointState& x) {
  return sign(x.velocity_rad_s) * elementary::exp(-x.distance_rad / 0.05);
}
double lag(const JointState& x) {
  return sign(x.acceleration_rad_s2) * elementary::exp(-std::abs(x.velocity_rad_s) / 0.12);
}
double inertia(const JointState& x) { return x.acceleration_rad_s2; }
double coupling(const JointState& x) { return x.other_velocity_rad_s; }

double velocity_bump(const JointState& x) {
  return sign(x.velocity_rad_s) * bump(std::abs(x.velocity_rad_s), 0.35, 0.04);
}
double position_bump(const JointState& x) { return bump(x.position_rad, 0.6, 0.15); }
double temperature_position(const JointState& x) {
  return (x.temperature_degc - 32) / 8 * elementary::cos(2 * x.position_rad + 0.4);
}
double slow_oscillation(const JointState& x) {
  return elementary::sin(2 * kPi * 3.3 * x.campaign_part + 1.1);
}

}  // namespace

const std::vector<PlantedShape>& planted_shapes() {
  static const std::vector<PlantedShape> kShapes = {
      {"stribeck", "s exp(-(|v|/0.06)^2)", true, {Role::velocity}, stribeck},
      {"nonlinear_viscous", "s v^4", true, {Role::velocity}, nonlinear_viscous},
      {"load_coulomb", "s |g|", true, {Role::gravity_torque}, load_coulomb},
      {"load_viscous", "v |g|", true, {Role::velocity, Role::gravity_torque}, load_viscous},
      {"power_quadrant_gain", "g", true, {Role::gravity_torque}, quadrant_gain},
      {"power_quadrant_step", "tanh(g/0.8)", true, {Role::gravity_torque}, quadrant_step},
      {"payload", "sin(q) + 0.3 cos(q)", true, {Role::position}, payload},
      {"output_ripple", "cos(3 q + 0.7)", true, {Role::position}, output_ripple},
      {"gear_ripple", "cos(160 q + 0.7)", true, {Role::position}, gear_ripple},
      {"temperature",
       "v exp(-(T - 24)/12)",
       true,
       {Role::velocity, Role::temperature},
       temperature},
      {"drift", "s u", true, {Role::time}, drift},
      {"hysteresis", "s exp(-d/0.05)", true, {Role::position}, hysteresis},
      {"lag", "sgn(a) exp(-|v|/0.12)", true, {Role::velocity, Role::acceleration}, lag},
      {"inertia", "a", true, {Role::acceleration}, inertia},
      {"coupling", "v2", true, {Role::other_velocity}, coupling},
      {"velocity_bump", "s exp(-((|v| - 0.35)/0.04)^2)", false, {Role::velocity}, velocity_bump},
      {"position_bump", "exp(-((q - 0.6)/0.15)^2)", false, {Role::position}, position_bump},
      {"temperature_position",
       "(T - 32)/8 cos(2 q + 0.4)",
       false,
       {Role::temperature, Role::position},
       temperature_position},
      {"slow_oscillation", "sin(2 pi 3.3 u + 1.1)", false, {Role::time}, slow_oscillation}};
  return kShapes;
}

const PlantedShape& find_planted_shape(std::string_view family) {
  std::vector<std::string> names;
  for (const PlantedShape& shape : planted_shapes()) {
    if (shape.family == family) return shape;
    names.emplace_back(shape.family);
  }
  throw_bad_input(fmt::format("there is no effect '{}' to plant", family), {},
                  did_you_mean(family, names));
}

}  // namespace tribench
