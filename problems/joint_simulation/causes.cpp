// SPDX-License-Identifier: MIT
#include "problems/joint_simulation/causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <iterator>
#include <numbers>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench::simulation {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;

double velocity(const Instant& now) { return now.joint.velocity_rad_s; }

// Keeps up with an input after `constant_s` seconds; exact for an input that stands still in a
// step.
class Lag {
 public:
  explicit Lag(double constant_s) : constant_s_(constant_s) {}
  double next(double input, double dt_s) {
    value_ = started_ ? input + (value_ - input) * elementary::exp(-dt_s / constant_s_) : input;
    started_ = true;
    return value_;
  }

 private:
  double constant_s_;
  double value_ = 0;
  bool started_ = false;
};

// The bristles' deflection as a share of what Coulomb friction takes: relaxes towards the sign of
// the velocity over `length_rad` of path.
class Bristles {
 public:
  explicit Bristles(double length_rad) : length_rad_(length_rad) {}
  double next(const Instant& now, double dt_s, double height = 1) {
    const double goal = now.sign() * height;
    const double path = std::abs(velocity(now)) * dt_s;
    deflection_ = goal + (deflection_ - goal) * elementary::exp(-path / (length_rad_ * height));
    return deflection_;
  }

 private:
  double length_rad_;
  double deflection_ = 0;
};

double bump(double x, double width) { return elementary::exp(-(x / width) * (x / width)); }

Response exponential_stribeck(RandomStream random) {
  return [vs = random.uniform(0.04, 0.09)](const Instant& now, double) {
    return now.sign() * elementary::exp(-std::abs(velocity(now)) / vs);
  };
}

Response stribeck_forwards(RandomStream random) {
  return [vs = random.uniform(0.04, 0.10)](const Instant& now, double) {
    return velocity(now) > 0 ? bump(velocity(now), vs) : 0;
  };
}

Response curved_viscous(RandomStream random) {
  return [power = random.uniform(1.6, 2.6)](const Instant& now, double) {
    return now.sign() * elementary::pow(std::abs(velocity(now)), power);
  };
}

Response load(RandomStream /*random*/) {
  return [](const Instant& now, double) { return now.sign() * std::abs(now.gravity_nm); };
}

Response inertia(RandomStream /*random*/) {
  return [](const Instant& now, double) { return now.joint.acceleration_rad_s2; };
}

Response coupling(RandomStream /*random*/) {
  return [](const Instant& now, double) { return now.other.velocity_rad_s; };
}

// What a lagging velocity makes of friction that falls and rises with it.
Response lagging_velocity(RandomStream random) {
  return [lag = Lag(random.uniform(0.03, 0.1)), width = random.uniform(0.06, 0.15)](
             const Instant& now, double dt_s) mutable {
    const auto friction = [width](double v) { return elementary::tanh(v / width) + 0.5 * v; };
    return friction(lag.next(velocity(now), dt_s)) - friction(velocity(now));
  };
}

Response lagging_friction(RandomStream random) {
  return [lag = Lag(random.uniform(0.03, 0.1)), width = random.uniform(0.06, 0.15)](
             const Instant& now, double dt_s) mutable {
    const double friction = elementary::tanh(velocity(now) / width) + 0.5 * velocity(now);
    return lag.next(friction, dt_s) - friction;
  };
}

// Friction of the velocity a fixed time before: a pure time lag (Hess and Soom 1990).
Response late_friction(RandomStream random) {
  return [lag_s = random.uniform(0.03, 0.12), width = random.uniform(0.06, 0.15),
          before = std::deque<double>()](const Instant& now, double dt_s) mutable {
    const auto friction = [&](double v) { return elementary::tanh(v / width) + 0.5 * v; };
    before.push_back(velocity(now));
    const auto kept = static_cast<std::size_t>(std::round(lag_s / dt_s)) + 1;
    while (before.size() > kept) before.pop_front();
    return friction(before.front()) - friction(velocity(now));
  };
}

Response dahl(RandomStream random) {
  return
      [bristles = Bristles(random.uniform(0.02, 0.08))](const Instant& now, double dt_s) mutable {
        return bristles.next(now, dt_s) - now.sign();
      };
}

// Less Coulomb friction: what is left are presliding, the bristles' damping and the Stribeck dip.
Response lugre(RandomStream random) {
  return [bristles = Bristles(random.uniform(0.02, 0.06)), vs = random.uniform(0.05, 0.12),
          damping_s = random.uniform(0.005, 0.02),
          before = 0.0](const Instant& now, double dt_s) mutable {
    const double deflection = bristles.next(now, dt_s, 1 + 0.3 * bump(velocity(now), vs));
    const double rate = (deflection - before) / dt_s;
    before = deflection;
    return deflection + damping_s * rate - now.sign();
  };
}

// Four elements in parallel that stick until they slide (Al-Bender, Lampaert, Swevers 2005), less
// what they take when all slide. Shares and limits are drawn, no two of one length.
Response maxwell_slip(RandomStream random) {
  struct Element {
    double limit_rad = 0;
    double share = 0;
    double deflection_rad = 0;
  };
  std::array<Element, 4> elements;
  double limit_rad = random.uniform(0.01, 0.02);
  double whole = 0;
  for (Element& one : elements) {
    one = {limit_rad, random.uniform(0.5, 1.5), 0};
    whole += one.share;
    limit_rad *= random.uniform(1.4, 2.2);
  }
  for (Element& one : elements) one.share /= whole;
  return [elements](const Instant& now, double dt_s) mutable {
    double force = -now.sign();
    for (Element& one : elements) {
      one.deflection_rad =
          std::clamp(one.deflection_rad + velocity(now) * dt_s, -one.limit_rad, one.limit_rad);
      force += one.share * one.deflection_rad / one.limit_rad;
    }
    return force;
  };
}

Response exponential_run_in(RandomStream random) {
  return [constant = random.uniform(0.15, 0.5)](const Instant& now, double) {
    return now.sign() * elementary::exp(-now.part / constant);
  };
}

Response logarithmic_run_in(RandomStream random) {
  return [start = random.uniform(0.02, 0.1)](const Instant& now, double) {
    return -now.sign() * elementary::log1p(now.part / start);
  };
}

// Three harmonics of a wave with `first` periods a turn; its phase moves by `drift` rad while the
// campaign lasts.
Response ripple(double first, double drift, bool harmonics, RandomStream random) {
  std::array<double, 3> phases{};
  for (double& phase : phases) phase = random.uniform(0, kWholeTurn);
  const double second = harmonics ? random.uniform(0.3, 0.7) : 0;
  const double third = harmonics ? random.uniform(0.2, 0.4) : 0;
  return [=](const Instant& now, double) {
    const double angle = first * now.joint.position_rad + drift * now.part;
    return elementary::cos(angle + phases[0]) + second * elementary::cos(2 * angle + phases[1]) +
           third * elementary::cos(3 * angle + phases[2]);
  };
}

Response output_harmonics(RandomStream random) {
  const auto first = static_cast<double>(1 + random.below(3));
  return ripple(first + 1, 0, true, random.split("wave"));
}
Response output_drifting(RandomStream random) {
  const auto first = static_cast<double>(2 + random.below(4));
  return ripple(first, random.uniform(0.6, 1.8), false, random.split("wave"));
}
// A bearing or a seal that runs out.
Response friction_ripple(RandomStream random) {
  const auto waves = static_cast<double>(1 + random.below(6));
  return [waves, phase = random.uniform(0, kWholeTurn)](const Instant& now, double) {
    return now.sign() * elementary::cos(waves * now.joint.position_rad + phase);
  };
}
Response gear_harmonics(RandomStream random) {
  return ripple(kGearRatio, 0, true, random.split("wave"));
}
Response gear_drifting(RandomStream random) {
  return ripple(kGearRatio, random.uniform(0.6, 1.8), false, random.split("wave"));
}

// Viscosity falls with the lubricant's temperature, which is not measured.
Response warm_oil(RandomStream random) {
  return [scale = random.uniform(8, 20)](const Instant& now, double) {
    return velocity(now) * elementary::exp(-(now.oil_degc - kCoolest_degc) / scale);
  };
}

// The gravity that was subtracted is of another mass and a little turned.
Response wrong_gravity(RandomStream random) {
  return [turned = random.uniform(-0.3, 0.3)](const Instant& now, double) {
    return now.gravity_amplitude_nm *
           elementary::sin(now.joint.position_rad + now.gravity_phase_rad + turned);
  };
}

// A damaged tooth: the same narrow place in every pass.
Response notch(RandomStream random) {
  return [centre = random.uniform(-1, 1), width = random.uniform(0.03, 0.08)](
             const Instant& now, double) { return bump(now.joint.position_rad - centre, width); };
}

// A balancing spring, a cable or a hose: slack at one position, stiffer away from it.
Response spring(RandomStream random) {
  return [slack = random.uniform(-0.5, 0.5), stiffening = random.uniform(0, 0.5)](
             const Instant& now, double) {
    const double way = now.joint.position_rad - slack;
    return way + stiffening * way * way * way;
  };
}

// A tool that every second to fifth movement carries, and nobody wrote it down.
Response load_by_movement(RandomStream random) {
  const double share = random.uniform(0.2, 0.6);
  return [share, first = random.uniform()](const Instant& now, double) {
    const double turns = share * (static_cast<double>(now.movement) + first);
    const bool is_loaded = std::floor(turns + share) > std::floor(turns);
    return is_loaded ? elementary::sin(now.joint.position_rad + now.gravity_phase_rad) : 0;
  };
}

// Friction that nothing recorded explains and that is another one in every movement.
Response friction_by_movement(RandomStream random) {
  return [random](const Instant& now, double) {
    return now.sign() * random.split(now.movement).normal();
  };
}

// Of the speed, the load, the acceleration and the other joint.
std::vector<Cause> causes_of_speed_and_load() {
  using enum Role;
  return {{"stribeck_exponential",
           "s exp(-|v|/vs)",
           {"stribeck"},
           {},
           {Role::velocity},
           false,
           exponential_stribeck},
          {"stribeck_forwards",
           "exp(-(v/vs)^2), forwards only",
           {"stribeck"},
           {},
           {Role::velocity},
           false,
           stribeck_forwards},
          {"viscous_power",
           "s |v|^p",
           {"nonlinear_viscous"},
           {},
           {Role::velocity},
           false,
           curved_viscous},
          {"load", "s |g|", {"load_coulomb"}, {}, {gravity_torque}, false, load},
          {"inertia", "a", {"inertia"}, {"lag"}, {acceleration}, false, simulation::inertia},
          {"coupling",
           "the other joint's velocity",
           {"coupling"},
           {},
           {other_velocity},
           false,
           simulation::coupling}};
}

// Of what the joint has done before.
std::vector<Cause> causes_of_memory_and_wear() {
  using enum Role;
  return {
      // The part of a lag that is linear in the velocity is an inertia and nothing else.
      {"lag_of_velocity",
       "friction of a velocity filtered to first order",
       {"lag", "inertia"},
       {"hysteresis"},
       {Role::velocity, acceleration},
       true,
       lagging_velocity},
      {"lag_of_friction",
       "friction filtered to first order",
       {"lag", "hysteresis", "inertia"},
       {},
       {Role::velocity, acceleration},
       true,
       lagging_friction},
      {"presliding_dahl",
       "Dahl's bristles less Coulomb friction",
       {"hysteresis"},
       {"lag"},
       {position},
       true,
       dahl,
       true},
      {"presliding_lugre",
       "LuGre's bristles less Coulomb friction",
       {"hysteresis", "stribeck"},
       {"lag"},
       {position},
       true,
       lugre,
       true},
      {"run_in_exponential", "s exp(-t/tau)", {"drift"}, {}, {time}, false, exponential_run_in},
      {"run_in_logarithm", "-s log(1 + t/tau)", {"drift"}, {}, {time}, false, logarithmic_run_in}};
}

// Of the position and the temperature.
std::vector<Cause> causes_of_position_and_temperature() {
  using enum Role;
  return {{"output_ripple_harmonics",
           "three harmonics of the output's turn",
           {"output_ripple"},
           {},
           {position},
           false,
           output_harmonics},
          {"output_ripple_drifting",
           "a wave of the output whose phase drifts",
           {"output_ripple"},
           {},
           {position},
           false,
           output_drifting},
          {"gear_ripple_harmonics",
           "three harmonics of the motor's turn",
           {"gear_ripple"},
           {},
           {position},
           false,
           gear_harmonics},
          {"gear_ripple_drifting",
           "a wave of the motor whose phase drifts",
           {"gear_ripple"},
           {},
           {position},
           false,
           gear_drifting},
          {"temperature_lagged",
           "v exp(-T/T0) of oil that is ahead of the sensor",
           {"temperature"},
           {},
           {temperature},
           false,
           warm_oil},
          {"gravity_wrong",
           "G sin(q + a little)",
           {"power_quadrant_gain", "payload"},
           {},
           {gravity_torque, position},
           false,
           wrong_gravity},
          {"position_notch",
           "a narrow notch in position, in no library",
           {},
           {},
           {position},
           false,
           notch}};
}

// Told after the others were: the seeds of their runs in a study stay.
std::vector<Cause> later_causes() {
  return {{"presliding_gms",
           "four Maxwell-slip elements less Coulomb friction",
           {"hysteresis"},
           {"lag"},
           {Role::position},
           true,
           maxwell_slip,
           true,
           false},
          {"friction_ripple",
           "s cos(k q + phase)",
           {"output_ripple"},
           {},
           {Role::position},
           true,
           friction_ripple,
           false,
           false},
          {"load_by_movement",
           "G sin(q) in some of the movements, in no library",
           {},
           {"payload", "power_quadrant_gain"},
           {Role::movement},
           false,
           load_by_movement,
           false,
           false},
          {"friction_by_movement",
           "another s in every movement, in no library",
           {},
           {},
           {Role::movement},
           true,
           friction_by_movement,
           false,
           false},
          {"spring",
           "q - q0, stiffer away from q0",
           {"spring"},
           {"payload", "asymmetry"},
           {Role::position},
           false,
           spring,
           false,
           false},
          {"lag_of_a_dead_time",
           "friction of the velocity a fixed time before",
           {"lag", "inertia"},
           {"hysteresis"},
           {Role::velocity, Role::acceleration},
           true,
           late_friction,
           false,
           false}};
}

}  // namespace

const std::vector<Cause>& causes() {
  static const std::vector<Cause> kCauses = [] {
    std::vector<Cause> all = causes_of_speed_and_load();
    std::ranges::move(causes_of_memory_and_wear(), std::back_inserter(all));
    std::ranges::move(causes_of_position_and_temperature(), std::back_inserter(all));
    std::ranges::move(later_causes(), std::back_inserter(all));
    return all;
  }();
  return kCauses;
}

double relaxed_stiffness(const Response& response) {
  constexpr double kSpeed_rad_s = 1e-6;  // so slow that only the way counts
  constexpr double kStep_s = 1;
  Instant now;
  now.joint.velocity_rad_s = kSpeed_rad_s;
  // The first step sets the sign, the second begins a bristle's rate: not looked at.
  double before = 0;
  double after = 0;
  for (int step = 0; step < 8; ++step) {
    before = after;
    now.joint.position_rad += kSpeed_rad_s * kStep_s;
    after = response(now, kStep_s);
  }
  return (after - before) / (kSpeed_rad_s * kStep_s);
}

const Cause& find_cause(std::string_view name) {
  std::vector<std::string> names;
  for (const Cause& cause : causes()) {
    if (cause.name == name) return cause;
    names.emplace_back(cause.name);
  }
  throw_bad_input(fmt::format("there is no cause '{}' to simulate", name), {},
                  did_you_mean(name, names));
}

}  // namespace tribench::simulation
