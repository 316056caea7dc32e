// SPDX-License-Identifier: MIT
#include "problems/kuka/planted_entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string>

#include "foundation/random.hpp"
#include "problems/data_problem.hpp"
#include "problems/friction/planted_effects.hpp"
#include "problems/kuka/planted.hpp"
#include "problems/table.hpp"

namespace tribench::kuka {
namespace {

constexpr const char* kTarget = "friction_torque_Nm";
constexpr int kCollisions = 5;

using CaseOfSeed = std::function<PlantedCase(std::uint64_t)>;

std::vector<std::string> input_names(const Dataset& data) {
  std::vector<std::string> names;
  for (const Channel& channel : data.channels) {
    if (channel.name == kTarget) continue;
    names.push_back(channel.name);
    if (channel.role == Role::velocity || channel.role == Role::gravity_torque) {
      names.push_back("sgn_" + channel.name);
    }
  }
  return names;
}

Problem make_problem(const std::string& name, const std::string& summary,
                     const PlantedCase& planted, std::uint64_t seed) {
  const PlantedData run = make_planted(planted, seed);
  Problem problem = make_data_problem(run.data, nullptr, kTarget, input_names(run.data));
  problem.name = name;
  problem.summary = summary;
  problem.dataset = "undeclared";
  problem.joint = 2;
  problem.load = true;
  const std::vector<char> test =
      draw_test_movements(run.data, 0.2, RandomStream(key_of("undeclared/split")).split(seed));
  std::vector<char> train(test);
  for (char& mark : train) mark = mark == 0 ? 1 : 0;
  const KnownDataset known{run.data, run.truth.noise_free()};
  problem.stages.front().train = make_table(known, problem.inputs, kTarget, train);
  problem.test = make_table(known, problem.inputs, kTarget, test);
  return problem;
}

void add(std::vector<ProblemEntry>& entries, std::string name, std::string summary,
         CaseOfSeed planted) {
  auto make = [name, summary, planted](std::uint64_t seed) {
    return make_problem(name, summary, planted(seed), seed);
  };
  auto data = [planted](std::uint64_t seed) { return make_planted(planted(seed), seed).data; };
  entries.push_back({std::move(name), std::move(summary), std::move(make), std::move(data)});
}

void add_case(std::vector<ProblemEntry>& entries, std::string name, std::string summary,
              PlantedCase planted) {
  add(entries, std::move(name), std::move(summary),
      [planted = std::move(planted)](std::uint64_t) { return planted; });
}

}  // namespace

void add_planted_entries(std::vector<ProblemEntry>& entries) {
  for (const PlantedShape& shape : planted_shapes()) {
    for (const double scale : {0.25, 0.5, 1.0, 2.0, 4.0}) {
      PlantedCase planted;
      planted.effects = {{std::string(shape.family), scale}};
      add_case(entries, fmt::format("undeclared/{}/{}", shape.family, scale),
               fmt::format("{} at {} times the noise{}", shape.formula, scale,
                           shape.in_library ? "" : ", in no library"),
               std::move(planted));
    }
  }
  for (const double scale : {0.5, 1.0, 2.0}) {
    add(entries, fmt::format("undeclared/pair/{}", scale),
        fmt::format("two effects drawn with the seed, each at {} times the noise", scale),
        [scale](std::uint64_t seed) { return draw_pair(scale, seed); });
  }
  PlantedCase hard;
  hard.noise = NoiseKind::hard;
  PlantedCase constant_velocity;
  constant_velocity.trajectories = 0;
  add_case(entries, "undeclared/none/ordinary", "nothing is missing", {});
  add_case(entries, "undeclared/none/hard", "nothing is missing, hard noise", hard);
  add_case(entries, "undeclared/none/constant_velocity",
           "nothing is missing, constant velocities only", constant_velocity);
  for (const double scale : {8.0, 16.0}) {
    PlantedCase collisions;
    collisions.collisions = kCollisions;
    collisions.collision_scale = scale;
    add_case(entries, fmt::format("undeclared/collision/{}", scale),
             fmt::format("{} bursts of {} times the noise, nothing else", kCollisions, scale),
             collisions);
  }
}

}  // namespace tribench::kuka
