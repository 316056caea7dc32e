// SPDX-License-Identifier: MIT
//
// A world on disk, asked by one command after the other, its truth sealed until it is asked for.
//
//   world.json     what may be known: limits, and the SHA-256 of key and truth
//   sealed.json    what is not to be looked at: seed, level, kind; the key
//   executed.csv   the movements done so far, in order; the state of the joint follows from them
//   revealed.json  once revealed: truth and key. From then on nothing is executed any more.
//
// The seal shows that a truth was fixed beforehand; it keeps no secret from whoever chose the seed.
// Who wants one draws a seed of 64 bits and keeps the folder (docs/challenge.md).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "problems/experiment/motion_limits.hpp"
#include "problems/experiment/planned_movement.hpp"
#include "problems/joint_simulation/world.hpp"

namespace tribench {

// The truth as text, for seals and scorers: kind, level, seed, noise, and each cause with the names
// that are right for it.
std::string truth_json(const simulation::WorldTruth& truth);
// Of the plan alone.
std::string seal_key(const simulation::WorldPlan& plan);
// The key, a line feed, the truth: its SHA-256 is the seal, which is published first.
std::string sealed_text(const simulation::WorldTruth& truth);
std::string seal_of(const simulation::WorldTruth& truth);

std::string limits_json(const MotionLimits& limits);
// Throws Error (bad_input): not JSON, an unknown key, a number out of its range.
MotionLimits read_limits(std::string_view text, const std::string& place);

// Takes a recording to where it is safe, before its movements count as executed: where that fails
// or is cut off, the folder is as before and the same movements give the same rows.
using KeepRows = std::function<void(const Dataset&)>;

class WorldFolder {
 public:
  // Throws Error (bad_input) where the folder holds a world already.
  static WorldFolder create(const std::filesystem::path& folder, const simulation::WorldPlan& plan);
  // Repeats what was executed. Throws Error (bad_input) where there is no world, or its seal does
  // not fit the truth that its plan gives: a file was changed, or another version drew it.
  explicit WorldFolder(const std::filesystem::path& folder);

  const simulation::World& world() const { return world_; }
  bool revealed() const;

  // All of them or none: a movement that breaks a limit is refused with its place ("FILE, movement
  // 3") and the mend, and nothing has happened. The answer is one dataset.
  Dataset execute(const std::vector<PlannedMovement>& movements, const std::string& file,
                  const KeepRows& keep = {});

  // Checks the seal, writes revealed.json and returns it.
  std::string reveal();

 private:
  WorldFolder(std::filesystem::path folder, const simulation::WorldPlan& plan);
  void append(const std::vector<PlannedMovement>& movements);
  void check_seal() const;

  std::filesystem::path folder_;
  simulation::World world_;
  std::vector<PlannedMovement> executed_;
};

}  // namespace tribench
