// SPDX-License-Identifier: MIT
#include "harness/cli/world_options.hpp"

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "harness/cli/choice_option.hpp"

namespace tribench {

void add_world_level(CLI::App& command, WorldChoice& choice) {
  std::vector<std::pair<std::string, simulation::WorldLevel>> levels;
  for (const simulation::WorldLevel one : simulation::kWorldLevels) {
    levels.emplace_back(world_level_name(one), one);
  }
  take_one_of(command.add_option("--level", choice.level,
                                 "how hard what is missing is to see: 2 to 4, 1 to 2, 0.5 to 1 "
                                 "times the noise"),
              levels)
      ->default_str("medium");
}

void add_world_choice(CLI::App& command, WorldChoice& choice) {
  add_world_level(command, choice);
  std::vector<std::pair<std::string, simulation::WorldKind>> kinds;
  for (const simulation::WorldKind one : simulation::kWorldKinds) {
    kinds.emplace_back(world_kind_name(one), one);
  }
  take_one_of(command.add_option("--kind", choice.kind,
                                 "what is missing: nothing, one cause, two, one that no library "
                                 "has; else drawn"),
              kinds);
}

}  // namespace tribench
