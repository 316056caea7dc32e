// SPDX-License-Identifier: MIT
#include "harness/motion/simulator_friction.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/forward_dynamics/forward_simulation.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/sign.hpp"

namespace tribench {
namespace {

constexpr std::size_t kSpeeds = 200;  // each way, alike for both
constexpr std::size_t kPlaces = 65;   // of the other inputs: the centre and pairs
constexpr std::size_t kAlong = 16;    // of one input over its range, where the others stay
constexpr double kBarely = 1e-6;      // of the top speed: motion begins
constexpr double kSettled_s = 1e9;    // a state at a constant velocity has settled
constexpr double kSine_s = 2;         // period of the motion by which parameters are compared
constexpr std::size_t kSineRows = 2000;

// The i-th of a sequence that fills [0, 1) evenly (van der Corput; Halton 1960).
double radical_inverse(std::size_t i, std::size_t base) {
  double value = 0;
  double digit = 1;
  for (; i > 0; i /= base) {
    digit /= static_cast<double>(base);
    value += digit * static_cast<double>(i % base);
  }
  return value;
}

std::size_t prime(std::size_t k) {
  constexpr std::array<std::size_t, 16> kPrimes = {2,  3,  5,  7,  11, 13, 17, 19,
                                                   23, 29, 31, 37, 41, 43, 47, 53};
  return kPrimes[k % kPrimes.size()];
}

// The formula at points of the box; signs and states follow from the rest.
class BoxFormula {
 public:
  BoxFormula(std::string_view text, NamedBox& box, const std::string& velocity,
             const std::string& acceleration)
      : formula_(parse_stateful_over(text, box)) {
    names_ = box.names;
    ranges_ = box.ranges;
    velocity_ = place_of(velocity);
    if (velocity_ == names_.size() ||
        !(ranges_[velocity_].low < 0 && ranges_[velocity_].high > 0)) {
      throw_bad_input(fmt::format("the velocity '{}' has no range around 0", velocity), "--box",
                      fmt::format("add {}=LOW:HIGH with both directions", velocity));
    }
    acceleration_ = place_of(acceleration);
    for (std::size_t j = 0; j < names_.size(); ++j) {
      const bool is_state = std::ranges::count(formula_.states, names_[j], &StateDeclaration::name);
      if (!is_state && !ranges_[j].sign_of && j != velocity_) free_.push_back(j);
    }
  }

  double top_speed() const { return std::min(-ranges_[velocity_].low, ranges_[velocity_].high); }
  bool reads_acceleration() const {
    return acceleration_ < names_.size() &&
           std::ranges::any_of(formula_.formula.nodes(), [this](const Node& node) {
             return node.is_variable() && node.variable == acceleration_;
           });
  }
  bool remembers() const { return !formula_.states.empty(); }
  const std::vector<std::size_t>& free() const { return free_; }
  const std::string& name(std::size_t j) const { return names_[j]; }
  bool is_acceleration(std::size_t j) const { return j == acceleration_; }

  std::vector<double> centre() const {
    std::vector<double> point(names_.size(), 0);
    for (const std::size_t j : free_) {
      point[j] = is_acceleration(j) ? 0 : 0.5 * (ranges_[j].low + ranges_[j].high);
    }
    return point;
  }
  // Other inputs at place k of the sequence; the first is the centre, of the others each even one
  // mirrors the one before: what is odd about the centre has no mean.
  std::vector<double> place(std::size_t k) const {
    std::vector<double> point = centre();
    if (k == 0) return point;
    for (std::size_t f = 0; f < free_.size(); ++f) {
      const InputRange& range = ranges_[free_[f]];
      const double share = radical_inverse((k + 1) / 2, prime(f));
      point[free_[f]] = range.low + (range.high - range.low) * (k % 2 == 1 ? share : 1 - share);
    }
    return point;
  }
  // All corners of the other inputs' box; of many inputs the last ones stay at their centre.
  std::vector<std::vector<double>> corners() const {
    constexpr std::size_t kMost = 8;  // inputs
    const std::size_t inputs = std::min(kMost, free_.size());
    std::vector<std::vector<double>> all;
    for (std::size_t mask = 0; mask < (std::size_t{1} << inputs); ++mask) {
      all.push_back(centre());
      for (std::size_t f = 0; f < inputs; ++f) {
        const InputRange& range = ranges_[free_[f]];
        all.back()[free_[f]] = (mask >> f & 1) != 0 ? range.high : range.low;
      }
    }
    return all;
  }

  double at(std::vector<double> point, double v) {
    point[velocity_] = v;
    for (std::size_t j = 0; j < names_.size(); ++j) {
      if (ranges_[j].sign_of) point[j] = sign(point[*ranges_[j].sign_of]);
    }
    for (const StateDeclaration& state : formula_.states) {
      StateDrive drive;
      if (!state.drives.empty()) drive.velocity = point[state.drives[0]];
      if (state.drives.size() > 1) drive.load = point[state.drives[1]];
      StateMemory memory = state_at_rest(state.law, drive);
      advance<double>(state.law, std::span<const double>(state.parameters), memory, drive, drive,
                      kSettled_s);
      point[place_of(state.name)] = memory.z;
    }
    const double value = evaluator_.evaluate_at(formula_.formula, point);
    if (!std::isfinite(value)) {
      throw_bad_input(fmt::format("the formula has no finite value at {}", words(point)), "--box",
                      "narrow the box; see: tribench check");
    }
    return value;
  }

  // Of the values over input j's range, the other inputs as they are: what is lost by who knows all
  // but that input, and gives their mean.
  double variance_along(std::size_t j, std::vector<double> point, double v) {
    std::array<double, kAlong> values{};
    double mean = 0;
    for (std::size_t k = 0; k < kAlong; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / kAlong;
      point[j] = ranges_[j].low + (ranges_[j].high - ranges_[j].low) * share;
      values[k] = at(point, v);
      mean += values[k] / kAlong;
    }
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return squares / kAlong;
  }

  std::string words(const std::vector<double>& point) const {
    std::vector<std::string> parts = {
        fmt::format("{}={:.4g}", names_[velocity_], point[velocity_])};
    for (const std::size_t j : free_)
      parts.push_back(fmt::format("{}={:.4g}", names_[j], point[j]));
    return fmt::format("{}", fmt::join(parts, ", "));
  }
  std::string words(std::vector<double> point, double v) const {
    point[velocity_] = v;
    return words(point);
  }

 private:
  std::size_t place_of(std::string_view name) const {
    return static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
  }

  StatefulFormula formula_;
  std::vector<std::string> names_;
  InputBox ranges_;
  std::size_t velocity_ = 0;
  std::size_t acceleration_ = 0;
  std::vector<std::size_t> free_;  // inputs that are neither velocity, sign nor state
  Evaluator evaluator_;
};

// Values over speeds (slowest first) x places, forwards and backwards.
struct Samples {
  std::vector<double> speeds;
  std::vector<std::vector<double>> places;
  std::vector<std::vector<double>> forwards;  // [speed][place]
  std::vector<std::vector<double>> backwards;
};

Samples sample(BoxFormula& formula) {
  Samples all;
  const std::size_t places = formula.free().empty() ? 1 : kPlaces;
  for (std::size_t k = 0; k < places; ++k) all.places.push_back(formula.place(k));
  for (std::size_t i = 0; i < kSpeeds; ++i) {
    const double speed =
        formula.top_speed() * (static_cast<double>(i) + 0.5) / static_cast<double>(kSpeeds);
    all.speeds.push_back(speed);
    auto& ahead = all.forwards.emplace_back();
    auto& back = all.backwards.emplace_back();
    for (const std::vector<double>& place : all.places) {
      ahead.push_back(formula.at(place, speed));
      back.push_back(formula.at(place, -speed));
    }
  }
  return all;
}

// coulomb, viscous, armature >= 0: the normal equations of F = c s + d v (+ m a).
void fit_parameters(const BoxFormula& formula, const Samples& all, SimulatorFriction& to) {
  std::size_t a_place = 0;
  const bool with_armature = formula.reads_acceleration();
  for (const std::size_t j : formula.free()) {
    if (formula.is_acceleration(j)) a_place = j;
  }
  const std::size_t p = with_armature ? 3 : 2;
  std::vector<double> a(p * p, 0);
  std::vector<double> b(p, 0);
  double squares = 0;
  double count = 0;
  const auto add = [&](double s, double v, const std::vector<double>& place, double value) {
    const std::array<double, 3> row = {s, v, with_armature ? place[a_place] : 0};
    for (std::size_t j = 0; j < p; ++j) {
      b[j] += row[j] * value;
      for (std::size_t k = 0; k < p; ++k) a[j * p + k] += row[j] * row[k];
    }
    squares += value * value;
    ++count;
  };
  for (std::size_t i = 0; i < all.speeds.size(); ++i) {
    for (std::size_t k = 0; k < all.places.size(); ++k) {
      add(1, all.speeds[i], all.places[k], all.forwards[i][k]);
      add(-1, -all.speeds[i], all.places[k], all.backwards[i][k]);
    }
  }
  const std::vector<char> held(p, 1);
  std::vector<double> solution(p, 0);
  solve_quadratic(a, b, held, solution);
  to.coulomb = solution[0];
  to.viscous = solution[1];
  to.armature = with_armature ? solution[2] : 0;
  to.rms = std::sqrt(squares / count);
}

double representable(const SimulatorFriction& to, double v) {
  return to.coulomb * sign(v) + to.viscous * v;
}

void measure_errors(BoxFormula& formula, const Samples& all, SimulatorFriction& to) {
  double sum = 0;
  double count = 0;
  std::size_t a_place = 0;
  for (const std::size_t j : formula.free()) {
    if (formula.is_acceleration(j)) a_place = j;
  }
  const auto look = [&](double v, const std::vector<double>& place, double value) {
    const double inertial = to.armature > 0 ? to.armature * place[a_place] : 0;
    const double error = std::abs(value - representable(to, v) - inertial);
    if (error > to.worst_error) {
      to.worst_error = error;
      to.worst_at = formula.words(place, v);
    }
    return error;
  };
  const auto add = [&](double v, const std::vector<double>& place, double value) {
    sum += look(v, place, value);
    ++count;
  };
  for (std::size_t i = 0; i < all.speeds.size(); ++i) {
    for (std::size_t k = 0; k < all.places.size(); ++k) {
      add(all.speeds[i], all.places[k], all.forwards[i][k]);
      add(-all.speeds[i], all.places[k], all.backwards[i][k]);
    }
  }
  to.mean_error = sum / count;
  // The worst is often at the edge, which no sample of the inside reaches.
  for (const std::vector<double>& corner : formula.corners()) {
    for (const double speed : {kBarely * formula.top_speed(), formula.top_speed()}) {
      for (const double v : {speed, -speed}) look(v, corner, formula.at(corner, v));
    }
  }
  double starting = 0;
  for (const std::vector<double>& place : all.places) {
    const double v = kBarely * formula.top_speed();
    starting += 0.5 * (formula.at(place, v) - formula.at(place, -v));
  }
  to.breakaway = std::max(0.0, starting / static_cast<double>(all.places.size()));
}

// What a symmetric straight line cannot say, cause by cause. Of an input: the part of the variance
// over the box that is its own or goes with others (the total effect of Homma & Saltelli 1996), and
// not how far the values are from those at the middle, which the fitted numbers may not be.
void measure_losses(BoxFormula& formula, const Samples& all, SimulatorFriction& to) {
  double directions = 0;
  double shape = 0;
  for (std::size_t i = 0; i < all.speeds.size(); ++i) {
    double ahead = 0;
    double back = 0;
    for (std::size_t k = 0; k < all.places.size(); ++k) {
      ahead += all.forwards[i][k];
      back += all.backwards[i][k];
    }
    const auto n = static_cast<double>(all.places.size());
    const double even = 0.5 * (ahead + back) / n;
    const double odd = 0.5 * (ahead - back) / n - representable(to, all.speeds[i]);
    directions += even * even;
    shape += odd * odd;
  }
  const auto speeds = static_cast<double>(all.speeds.size());
  to.lost.push_back(
      {"the difference between the directions, and any offset", std::sqrt(directions / speeds)});
  to.lost.push_back({"the curve over the speed (Stribeck, saturation)", std::sqrt(shape / speeds)});
  for (const std::size_t j : formula.free()) {
    if (formula.is_acceleration(j) && to.armature > 0) continue;
    double squares = 0;
    double count = 0;
    for (std::size_t i = 0; i < all.speeds.size(); i += 4) {
      for (const std::vector<double>& place : all.places) {
        squares += formula.variance_along(j, place, all.speeds[i]) +
                   formula.variance_along(j, place, -all.speeds[i]);
        count += 2;
      }
    }
    const double rms = std::sqrt(squares / count);
    if (rms > 1e-9 * to.rms) {
      to.lost.push_back({fmt::format("the dependence on {}", formula.name(j)), rms});
    }
  }
  std::ranges::stable_sort(to.lost, std::ranges::greater(), &LostFriction::rms);
}

std::string own_formula(const SimulatorFriction& to, Simulator simulator, double top_speed) {
  const double excess = to.breakaway - to.coulomb;
  if (simulator == Simulator::isaac && excess > 0) {
    return fmt::format("sgn_v*({:.6g} + {:.6g}*exp(-(v/{:.3g})^2)) + {:.6g}*v", to.coulomb, excess,
                       1e-3 * top_speed, to.viscous);
  }
  return fmt::format("{:.6g}*sgn_v + {:.6g}*v", to.coulomb, to.viscous);
}

void measure_motion(BoxFormula& formula, double inertia, SimulatorFriction& to) {
  const double rate = 2 * std::numbers::pi / kSine_s;
  const double speed = 0.5 * formula.top_speed();
  to.amplitude = speed / rate;
  std::vector<double> time, position, velocity, drive;
  const std::vector<double> centre = formula.centre();
  for (std::size_t i = 0; i <= kSineRows; ++i) {
    const double t = kSine_s * static_cast<double>(i) / static_cast<double>(kSineRows);
    const double v = speed * elementary::sin(rate * t);
    time.push_back(t);
    position.push_back(to.amplitude * (1 - elementary::cos(rate * t)));
    velocity.push_back(v);
    const double barely = kBarely * formula.top_speed();
    const bool starts = i < kSineRows / 2;  // at a standstill: the friction of what follows
    const double moving = std::abs(v) > barely ? v : starts ? barely : -barely;
    drive.push_back(inertia * speed * rate * elementary::cos(rate * t) +
                    formula.at(centre, moving));
  }
  forward::JointModel model = forward::parse_joint(to.formula, {}, {}, "the parameters");
  model.inertia = inertia;
  const forward::MovementRows rows{time, position, velocity, drive, {}, {}, {}};
  const forward::MotionErrors errors =
      forward::motion_errors(rows, forward::simulate_motion(model, nullptr, rows, {}));
  to.inertia = inertia;
  to.mean_motion = errors.mean_position;
  to.largest_motion = errors.largest_position;
}

}  // namespace

const std::vector<std::string>& simulator_names() {
  static const std::vector<std::string> kNames = {"mujoco", "urdf", "isaac"};
  return kNames;
}

std::optional<Simulator> find_simulator(std::string_view name) {
  const auto found = std::ranges::find(simulator_names(), name);
  if (found == simulator_names().end()) return std::nullopt;
  return static_cast<Simulator>(found - simulator_names().begin());
}

SimulatorFriction fit_simulator_friction(std::string_view text, NamedBox box,
                                         const std::string& velocity,
                                         const std::string& acceleration, Simulator simulator,
                                         std::optional<double> inertia) {
  BoxFormula formula(text, box, velocity, acceleration);
  const Samples all = sample(formula);
  SimulatorFriction to;
  to.remembers = formula.remembers();
  fit_parameters(formula, all, to);
  measure_errors(formula, all, to);
  measure_losses(formula, all, to);
  to.formula = own_formula(to, simulator, formula.top_speed());
  if (inertia) measure_motion(formula, *inertia, to);
  return to;
}

}  // namespace tribench
