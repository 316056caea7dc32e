// SPDX-License-Identifier: MIT
//
// Which worlds: the options of every command that makes some.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "problems/joint_simulation/world.hpp"

namespace tribench {

struct WorldChoice {
  simulation::WorldLevel level = simulation::WorldLevel::medium;
  std::optional<simulation::WorldKind> kind;
  simulation::WorldPlan plan(std::uint64_t seed) const { return {seed, level, kind}; }
};

// Adds --level.
void add_world_level(CLI::App& command, WorldChoice& choice);
// Adds --level and --kind. choice must live as long as the command.
void add_world_choice(CLI::App& command, WorldChoice& choice);
// Adds --smallest-effect. otherwise: what it is where it is not given.
void add_smallest_effect(CLI::App& command, std::optional<double>& size,
                         const std::string& otherwise);

}  // namespace tribench
