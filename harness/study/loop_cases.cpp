// SPDX-License-Identifier: MIT
#include "harness/study/loop_cases.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "foundation/random.hpp"
#include "problems/friction/planted_effects.hpp"
#include "problems/joint_simulation/simulated_campaign.hpp"
#include "problems/kuka/planted.hpp"

namespace tribench {
namespace {

constexpr double kPlantedGearRatio = 160;

std::string families_of(const kuka::PlantedCase& planted) {
  std::string families;
  for (const kuka::Plant& plant : planted.effects) {
    families += (families.empty() ? "" : "+") + plant.family;
  }
  return families;
}

void add_case(std::vector<LoopCase>& cases, const std::string& group, double scale,
              const kuka::PlantedCase& planted, std::uint64_t seed) {
  LoopCase one;
  one.group = group;
  one.what = families_of(planted);
  one.scale = scale;
  one.seed = seed;
  one.gear_ratio = kPlantedGearRatio;
  one.make = [planted, seed] { return kuka::make_planted(planted, seed); };
  cases.push_back(std::move(one));
}

void add_cases(std::vector<LoopCase>& cases, const std::string& group, double scale,
               const kuka::PlantedCase& planted, std::uint64_t first, int runs) {
  for (int run = 0; run < runs; ++run) {
    add_case(cases, group, scale, planted, first + cases.size());
  }
}

void add_simulated(std::vector<LoopCase>& cases, const simulation::SimulatedCase& wanted,
                   std::uint64_t seed) {
  LoopCase one;
  one.group = "simulated";
  one.what = wanted.cause.empty() ? "none" : wanted.cause;
  one.noise = simulation::noise_name(wanted.noise);
  one.design = simulation::design_name(wanted.design);
  one.scale = wanted.cause.empty() ? 0 : wanted.scale;
  one.seed = seed;
  one.gear_ratio = simulation::kGearRatio;
  one.any_sign = false;
  one.make = [wanted, seed] { return simulation::simulate(wanted, seed); };
  cases.push_back(std::move(one));
}

}  // namespace

std::string LoopCase::key() const {
  if (noise.empty()) return fmt::format("{}/{}/{}/{}", group, what, scale, seed);
  return fmt::format("{}/{}/{}/{}/{}/{}", group, what, noise, design, scale, seed);
}

std::vector<LoopCase> make_loop_cases(int null_runs, int runs_per_cell, std::uint64_t first_seed) {
  std::vector<LoopCase> cases;
  const int part = std::max(1, null_runs / 5);
  kuka::PlantedCase hard;
  hard.noise = kuka::NoiseKind::hard;
  kuka::PlantedCase constant_velocity;
  constant_velocity.trajectories = 0;
  add_cases(cases, "null", 0, {}, first_seed, null_runs);
  add_cases(cases, "hard", 0, hard, first_seed, part);
  add_cases(cases, "constant_velocity", 0, constant_velocity, first_seed, part);
  for (const PlantedShape& shape : planted_shapes()) {
    for (const double scale : {0.25, 0.5, 1.0, 2.0, 4.0}) {
      kuka::PlantedCase planted;
      planted.effects = {{std::string(shape.family), scale}};
      add_cases(cases, shape.in_library ? "single" : "outside", scale, planted, first_seed,
                runs_per_cell);
    }
  }
  for (const double scale : {0.5, 1.0, 2.0}) {
    for (int run = 0; run < 7 * runs_per_cell / 2; ++run) {
      const std::uint64_t seed = first_seed + cases.size();
      add_case(cases, "pair", scale, kuka::draw_pair(scale, seed), seed);
    }
  }
  for (const double scale : {8.0, 16.0}) {
    kuka::PlantedCase planted;
    planted.collisions = 3;
    planted.collision_scale = scale;
    add_cases(cases, "collision", scale, planted, first_seed, 2 * runs_per_cell);
  }
  return cases;
}

std::vector<LoopCase> make_simulated_cases(int null_runs, int runs_per_cell,
                                           std::uint64_t first_seed) {
  const RandomStream random(key_of("loop_cases/simulated"));
  std::vector<LoopCase> cases;
  const auto draw_design = [](RandomStream& draw, bool needs_reversals) {
    simulation::Design design{};
    do {
      design = simulation::kDesigns[draw.below(simulation::kDesigns.size())];
    } while (needs_reversals && design == simulation::Design::one_way);
    return design;
  };
  for (const simulation::NoiseKind noise : simulation::kNoiseKinds) {
    for (int run = 0; run < null_runs; ++run) {
      const std::uint64_t seed = first_seed + cases.size();
      RandomStream draw = random.split(seed);
      add_simulated(cases, {"", 1, noise, draw_design(draw, false)}, seed);
    }
  }
  for (const simulation::Cause& cause : simulation::causes()) {
    for (const double scale : {0.5, 1.0, 2.0}) {
      for (int run = 0; run < runs_per_cell; ++run) {
        const std::uint64_t seed = first_seed + cases.size();
        RandomStream draw = random.split(seed);
        const simulation::NoiseKind noise =
            simulation::kNoiseKinds[draw.below(simulation::kNoiseKinds.size())];
        add_simulated(
            cases,
            {std::string(cause.name), scale, noise, draw_design(draw, cause.needs_reversals)},
            seed);
      }
    }
  }
  return cases;
}

}  // namespace tribench
