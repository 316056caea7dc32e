// SPDX-License-Identifier: MIT
#include "algorithms/exploration/fixed_plans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "algorithms/exploration/log_determinant.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "foundation/suggestion.hpp"

namespace tribench::loop {
namespace {

constexpr double kSlowest = 0.04;  // of the speed limit
constexpr double kPause_s = 3;
constexpr int kMostDraws = 1000;

std::optional<NextMovement> planned(PlannedMovement movement) {
  return NextMovement{std::move(movement), "planned"};
}

std::optional<NextMovement> drawn(const ExplorationState& state, RandomStream random) {
  const MotionLimits& limits = state.limits;
  for (int k = 0; k < kMostDraws; ++k) {
    const double speed =
        limits.speed_rad_s * kSlowest * elementary::pow(1 / kSlowest, random.uniform());
    const double a = random.uniform(limits.lowest_rad, limits.highest_rad);
    const double b = random.uniform(limits.lowest_rad, limits.highest_rad);
    const double load = random.uniform(limits.least_load_factor, limits.greatest_load_factor);
    const double low = std::min(a, b);
    const double high = std::max(a, b);
    PlannedMovement movement = random.chance(0.5)
                                   ? constant_movement(random.sign() * speed, low, high, load)
                                   : two_tone_movement(speed, low, high, load);
    movement.rest = random.chance(0.1) ? limits.longest_rest_s : kPause_s;
    movement.rest = std::min(movement.rest, limits.longest_rest_s);
    if (random.chance(0.5)) movement.other_velocity = limits.greatest_other_velocity_rad_s;
    const double seconds = seconds_of(movement, start_of(movement), limits);
    if (seconds < 0.5 || seconds > state.options.longest_s) continue;
    if (!broken_limit(movement, limits).broken()) return planned(movement);
  }
  return std::nullopt;
}

MovementPlan random_plan(std::uint64_t seed) {
  const RandomStream random = RandomStream(key_of("exploration/random")).split(seed);
  return [random](const ExplorationState& state) {
    return drawn(state, random.split(state.so_far.steps.size() + state.so_far.refused.size()));
  };
}

std::array<double, 3> loads_of(const MotionLimits& limits) {
  return {1, limits.greatest_load_factor, limits.least_load_factor};
}

MovementPlan sweep_plan(std::uint64_t /*seed*/) {
  return [](const ExplorationState& state) {
    constexpr std::array kParts = {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0};
    const MotionLimits& limits = state.limits;
    const std::size_t k = state.so_far.steps.size() + state.so_far.refused.size();
    const double speed = kParts[k / 2 % kParts.size()] * limits.speed_rad_s;
    const double load = loads_of(limits)[k / (2 * kParts.size()) % 3];
    PlannedMovement movement =
        constant_movement(k % 2 == 0 ? speed : -speed, limits.lowest_rad, limits.highest_rad, load);
    movement.rest = kPause_s;
    if (k % 4 >= 2) movement.other_velocity = limits.greatest_other_velocity_rad_s;
    return planned(movement);
  };
}

MovementPlan sine_plan(std::uint64_t /*seed*/) {
  return [](const ExplorationState& state) {
    constexpr std::array kParts = {1.0, 0.5, 0.75, 0.35};
    constexpr std::array kReach = {0.5, 0.125, 0.25};  // of the range
    const MotionLimits& limits = state.limits;
    const std::size_t k = state.so_far.steps.size() + state.so_far.refused.size();
    const double centre = 0.5 * (limits.lowest_rad + limits.highest_rad);
    const double half =
        kReach[k / kParts.size() % kReach.size()] * (limits.highest_rad - limits.lowest_rad);
    const double speed = kParts[k % kParts.size()] * limits.speed_rad_s;
    PlannedMovement movement =
        two_tone_movement(speed, centre - half, centre + half,
                          loads_of(limits)[k / (kParts.size() * kReach.size()) % 3]);
    movement.tones[0].amplitude = half;
    movement.tones[1] = {};
    movement.duration = 1 / movement.tones[0].frequency;
    movement.rest = kPause_s;
    if (k % 4 >= 2) movement.other_velocity = limits.greatest_other_velocity_rad_s;
    return planned(movement);
  };
}

MovementPlan d_optimal_plan(std::uint64_t /*seed*/) {
  return [opening = informative_movements()](
             const ExplorationState& state) -> std::optional<NextMovement> {
    if (state.last == nullptr) return opening(state);
    const EvidenceSums& sums = state.last->sums;
    const Eigen::MatrixXd seen = sums.products()
                                     .topLeftCorner(sums.base_count(), sums.base_count())
                                     .selfadjointView<Eigen::Lower>();
    const Eigen::MatrixXd information =
        seen + 1e-9 * seen.trace() * Eigen::MatrixXd::Identity(seen.rows(), seen.cols());
    const double before = log_determinant(information);
    double best = 0;
    std::optional<NextMovement> next;
    for (std::size_t m = 0; m < state.candidates.size(); ++m) {
      if (state.refused[m] != 0) continue;
      const MovementRows& movement = state.foreseen.movements[m];
      const RowRange& range = movement.rows;
      const Eigen::MatrixXd rows = state.foreseen.base.middleRows(
          static_cast<Eigen::Index>(range.begin), static_cast<Eigen::Index>(range.size()));
      const double cost = seconds_of(state.candidates[m], state.now.position_rad, state.limits);
      const double gain =
          (log_determinant(information + movement.counts * rows.transpose() * rows) - before) /
          cost;
      if (!(gain > best)) continue;
      best = gain;
      next = NextMovement{state.candidates[m], "planned", 0, m};
    }
    return next;
  };
}

MovementPlan informative_plan(std::uint64_t /*seed*/) { return informative_movements(); }

}  // namespace

const std::vector<NamedPlan>& movement_plans() {
  static const std::vector<NamedPlan> kPlans = {
      {"informative", "the movement that tells the explanations left apart soonest",
       informative_plan},
      {"random", "movements drawn within the limits", random_plan},
      {"sweep", "constant speeds over the whole range, there and back", sweep_plan},
      {"sines", "single tones at several speeds and ranges", sine_plan},
      {"d_optimal", "best for Coulomb and viscous friction", d_optimal_plan}};
  return kPlans;
}

const NamedPlan& find_plan(std::string_view name) {
  std::vector<std::string> names;
  for (const NamedPlan& plan : movement_plans()) {
    if (plan.name == name) return plan;
    names.emplace_back(plan.name);
  }
  throw_bad_input(fmt::format("there is no plan '{}'", name), {}, did_you_mean(name, names));
}

}  // namespace tribench::loop
