// SPDX-License-Identifier: MIT
#include "harness/study/loop_cases.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "problems/friction/planted_effects.hpp"

namespace tribench {
namespace {

void add_cases(std::vector<LoopCase>& cases, const std::string& group, double scale,
               const kuka::PlantedCase& planted, std::uint64_t first, int runs) {
  for (int run = 0; run < runs; ++run) {
    cases.push_back({group, scale, planted, first + cases.size()});
  }
}

}  // namespace

std::string LoopCase::key() const {
  std::string families;
  for (const kuka::Plant& plant : planted.effects) {
    families += (families.empty() ? "" : "+") + plant.family;
  }
  return fmt::format("{}/{}/{}/{}", group, families, scale, seed);
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
      cases.push_back({"pair", scale, kuka::draw_pair(scale, seed), seed});
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

}  // namespace tribench
