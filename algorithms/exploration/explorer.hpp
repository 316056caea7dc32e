// SPDX-License-Identifier: MIT
//
// The loop that experiments: assess what has been recorded, choose the movement that tells the
// explanations left apart soonest, have it executed, assess again; stop when sure, when the seconds
// are spent, or when no movement that the limits allow tells anything more.
//
//   const Exploration done = explore(limits, execute, options, informative_movements());
//
// Sure: what a verdict said of the rows before they came is 1/alpha times likelier than what all
// others said (forecasts.hpp), in hindsight it has all but half of alpha of the weight, and the
// loop's own diagnosis of the same rows says the same. A movement that is refused is asked for
// again after a rest.
//
// Who executes is the caller's business: a simulated world, a program, a robot. Deterministic given
// the answers. Cost: an assessment (assessment.hpp) a look; a look after every movement at first,
// then whenever the seconds have grown by a twentieth. The loop's own diagnosis, which takes
// longer, is asked only where the weights would stop.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/exploration/assessment.hpp"
#include "algorithms/exploration/foresight.hpp"
#include "algorithms/exploration/movement_choice.hpp"
#include "problems/dataset.hpp"
#include "problems/experiment/motion_limits.hpp"
#include "problems/experiment/planned_movement.hpp"

namespace tribench::loop {

struct ExplorerOptions {
  double alpha = 0.01;  // of naming anything else while one explanation is true
  double smallest_effect = kSmallestEffect;  // of interest, in the noise's (explanations.hpp)
  double budget_s = 600;                     // of motion
  double longest_s = 30;                     // of one movement that is proposed
  double start_rad = 0;                      // where the joint stands
  const std::atomic<bool>* stop = nullptr;   // looked at between movements
  // Told after every movement; may be empty.
  std::function<void(const struct ExplorationStep&)> told = {};
};

// The rows of a movement. Throws Error: bad_input where it is refused, and another one is asked
// for; any other kind ends the exploration, with what was recorded before.
using ExecuteMovement = std::function<Dataset(const PlannedMovement&)>;

struct ExplorationStep {
  PlannedMovement movement;
  double cost_s = 0;
  std::size_t rows = 0;
  std::string why;                       // what it was to tell apart; "opening", "planned"
  double expected = 0;                   // nats
  bool looked = false;                   // what follows is known
  std::vector<WeighedVerdict> verdicts;  // the five likeliest
  std::size_t left = 0;                  // different verdicts that cannot be excluded
};

enum class ExplorationEnd { sure, budget, nothing_tells, stopped, failed };
std::string_view exploration_end_name(ExplorationEnd end);

struct Exploration {
  ExplorationEnd end = ExplorationEnd::budget;
  std::string verdict;                // the likeliest; "NONE", "a+b", "UNKNOWN"
  std::vector<std::string> families;  // of the library, in it
  bool unknown = false;
  std::vector<std::string> inputs;   // where it lives, where unknown
  double weight = 0;                 // posterior of the verdict, in hindsight
  double log_e_value = 0;            // of what it said before the rows came (forecasts.hpp)
  std::vector<WeighedVerdict> left;  // that cannot be excluded, the likeliest first
  // What the loop's own diagnosis said when it was last asked, in the verdict's words; empty:
  // never.
  std::string diagnosis;
  std::vector<std::string> untestable;
  std::vector<std::string> refused;  // movements that were refused, and why
  std::string failure;               // of who executes, where that ended it
  double seconds = 0;
  std::vector<ExplorationStep> steps;
  Dataset data;
};

// What a plan may look at when it names the next movement.
struct ExplorationState {
  const MotionLimits& limits;
  const ExplorerOptions& options;
  const Exploration& so_far;
  const Assessment* last = nullptr;  // the last look, once there was one
  JointNow now;
  std::span<const PlannedMovement> candidates;
  const Foreseen& foreseen;          // of the candidates, once there was a look
  const std::vector<char>& refused;  // per candidate
  std::string disputed;              // what the diagnosis said instead of the likeliest verdict
};

struct NextMovement {
  PlannedMovement movement;
  std::string why;
  double expected = 0;
  std::optional<std::size_t> candidate = {};
};
// Nothing: the plan has no further movement.
using MovementPlan = std::function<std::optional<NextMovement>(const ExplorationState&)>;

// A few opening movements, then the one of the highest expected gain a second.
MovementPlan informative_movements();

Exploration explore(const MotionLimits& limits, const ExecuteMovement& execute,
                    const ExplorerOptions& options, const MovementPlan& plan);

// Appends the rows of a movement, under its own number. Throws Error (failed) where a channel is
// missing that the movements before had.
void append_movement(Dataset& data, const Dataset& movement);

}  // namespace tribench::loop
