// SPDX-License-Identifier: MIT
#include "harness/cli/world_options.hpp"

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "harness/cli/choice_option.hpp"
#include "harness/cli/number_options.hpp"

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

void add_smallest_effect(CLI::App& command, std::optional<double>& size,
                         const std::string& otherwise) {
  command
      .add_option("--smallest-effect", size,
                  "of interest, in units of the noise: what is smaller need not be found before it "
                  "is sure; " +
                      otherwise)
      ->transform(real_number(0.01, 100));
}

}  // namespace tribench
