// SPDX-License-Identifier: MIT
//
// Does choosing movements help? Many worlds, each explored by several plans under one rule of
// stopping: the seconds of motion to the right verdict, and how many verdicts are wrong.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/exploration/explorer.hpp"
#include "harness/study/loop_outcome.hpp"
#include "problems/joint_simulation/world.hpp"

namespace tribench {

struct ExplorationStudyOptions {
  int worlds = 20;
  std::uint64_t first_seed = 1;
  simulation::WorldLevel level = simulation::WorldLevel::medium;
  std::optional<simulation::WorldKind> kind = {};
  std::vector<std::string> plans;  // empty: all of movement_plans()
  double budget_s = 600;
  double alpha = 0.01;
  std::optional<double> smallest_effect = {};  // of interest; else that of the level
  int threads = 0;
  // Takes explorations.csv, a line an exploration, written as they end; what it holds of these is
  // not explored again. Empty: nothing is written.
  std::filesystem::path out;
  const std::atomic<bool>* stop = nullptr;  // explorations under way are dropped
  bool quiet = true;
};

struct ExplorationRun {
  std::string worlds;  // "medium", "medium pair": how they were drawn
  std::uint64_t seed = 0;
  double budget_s = 0;
  double alpha = 0;
  double smallest_effect = 0;
  std::string kind;
  std::string causes;  // "load+stribeck_forwards", "none"
  std::string plan;
  std::string verdict;
  double weight = 0;
  std::string end;        // "sure", "budget", ...
  std::string diagnosis;  // what the loop's own diagnosis said when it was last asked
  bool right = false;     // the causes and nothing else, in whatever shape
  Says says = Says::nothing;
  double seconds = 0;
  std::size_t movements = 0;
  double cpu_s = 0;
  // Wrong verdicts that the first look could not tell from a right one (at least a twentieth of its
  // weight), and those of them that the last look could not (a hundredth).
  std::size_t aliases = 0;
  std::size_t aliases_left = 0;

  bool stopped_sure() const { return end == "sure"; }
};

struct ExplorationFigure {
  std::string group;  // "all", a kind, a cause of single worlds
  std::string plan;
  std::size_t worlds = 0;
  std::size_t sure_right = 0;
  std::size_t sure_wrong = 0;
  // Of all worlds of the group; a world that did not end with the right verdict counts as the
  // budget.
  double median_seconds = 0;
  double median_movements = 0;  // of those that ended with the right verdict
  std::size_t aliases = 0;
  std::size_t aliases_left = 0;
};

struct ExplorationStudy {
  std::vector<ExplorationRun> runs;
  std::vector<ExplorationFigure> figures;
  std::size_t left_out = 0;  // explorations that were stopped, or not begun
};

ExplorationStudy run_exploration_study(const ExplorationStudyOptions& options);

// How an exploration of a world is judged, whoever explored it.
Says judge_verdict(const std::vector<std::string>& families, bool unknown,
                   const simulation::WorldTruth& truth);
bool is_right(Says says);

}  // namespace tribench
