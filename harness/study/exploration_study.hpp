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
  int threads = 0;
  std::filesystem::path out;  // explorations.csv is written there; empty: nowhere
  bool quiet = true;
};

struct ExplorationRun {
  std::uint64_t seed = 0;
  std::string kind;
  std::string causes;  // "load+stribeck_forwards", "none"
  std::string plan;
  std::string verdict;
  bool stopped_sure = false;
  bool right = false;  // the causes and nothing else, in whatever shape
  Says says = Says::nothing;
  double seconds = 0;
  std::size_t movements = 0;
  double cpu_s = 0;
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
};

struct ExplorationStudy {
  std::vector<ExplorationRun> runs;
  std::vector<ExplorationFigure> figures;
};

ExplorationStudy run_exploration_study(const ExplorationStudyOptions& options);

// How an exploration of a world is judged, whoever explored it.
Says judge_verdict(const std::vector<std::string>& families, bool unknown,
                   const simulation::WorldTruth& truth);
bool is_right(Says says);

}  // namespace tribench
