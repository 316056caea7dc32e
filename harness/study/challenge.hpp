// SPDX-License-Identifier: MIT
//
// "Name what is missing": sealed worlds as a benchmark for anybody's method. A program is started
// once a world and talks by lines of JSON on its standard streams (docs/challenge.md): it is told
// the limits, asks for movements, gets their rows, and says its verdict. What it says of itself is
// not believed: seconds are counted and verdicts judged here.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/study/exploration_study.hpp"
#include "problems/joint_simulation/world.hpp"

namespace tribench {

struct ChallengePlan {
  // Whose SHA-256 the worlds' seeds follow from: who does not know it cannot make them again.
  std::string secret = "practice";
  int worlds = 20;
  simulation::WorldLevel level = simulation::WorldLevel::medium;
  double wall_s = 600;  // that a program may take for a world
  bool quiet = true;    // no progress line
  // Once true, the world under way is dropped and its program ended; looked at every second.
  const std::atomic<bool>* end = nullptr;
};

std::vector<simulation::WorldPlan> challenge_worlds(const ChallengePlan& plan);

struct ChallengeResult {
  std::string seal;  // SHA-256 of the world's key and truth
  std::string kind;
  std::string verdict;  // "NONE", "a+b", "UNKNOWN"; "abstained", "failed"
  std::string reason;   // why it failed
  bool right = false;
  bool wrong = false;
  double seconds = 0;
  std::size_t movements = 0;
  std::size_t refused = 0;
};

struct ChallengeScore {
  std::string name;
  std::vector<ChallengeResult> results;
  std::size_t right() const;
  std::size_t wrong() const;
  // A verdict that is not right counts as all of the world's seconds.
  double median_seconds() const;
};

// One world; a program that fails or hangs fails that world alone. Nothing where `end` became true
// before the verdict. Throws Error (failed) where it cannot be started.
std::optional<ChallengeResult> run_challenge_world(const std::vector<std::string>& command,
                                                   const simulation::WorldPlan& plan, double wall_s,
                                                   const std::atomic<bool>* end = nullptr);

// Writes seals.json before the first program is started, NAME.json after each world, and at the end
// leaderboard.md, which has a line for every score on all of these worlds in the folder and names
// the others. stop: looked at between worlds; the score then has fewer results than the plan has
// worlds. Throws Error (bad_input) where the folder's seals.json is of other worlds.
ChallengeScore run_challenge(const ChallengePlan& plan, const std::string& name,
                             const std::vector<std::string>& command,
                             const std::filesystem::path& folder, const std::atomic<bool>& stop);

// The worlds' seeds, keys and truths as JSON, for when the challenge is over.
std::string revealed_challenge(const ChallengePlan& plan);

}  // namespace tribench
