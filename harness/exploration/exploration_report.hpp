// SPDX-License-Identifier: MIT
//
// An exploration as people read it: what was asked, why, what it told.
#pragma once

#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/exploration/explorer.hpp"

namespace tribench {

// The loop's own diagnosis of all that was recorded, beside the exploration's verdict: a second
// opinion, and the refitted model.
struct SecondOpinion {
  std::string verdict;  // "EFFECTS"; empty where nothing could be diagnosed
  std::vector<std::string> effects;
  std::string model;  // over the signals
};
SecondOpinion second_opinion(const loop::Exploration& done, double gear_ratio);

// {"verdict", "families", "unknown", "inputs", "weight", "end", "seconds", "alpha",
// "smallest_effect", "left", "untestable", "refused", "second_opinion", "path": [{"movement",
// "seconds", "why", "expected", "verdicts", "left"}]}. options: what it was explored by.
std::string exploration_json(const loop::Exploration& done, const SecondOpinion& second,
                             const loop::ExplorerOptions& options);
std::string exploration_markdown(const loop::Exploration& done, const SecondOpinion& second,
                                 const loop::ExplorerOptions& options);
// The verdict and what it rests on, a few lines.
std::string exploration_terminal(const loop::Exploration& done, const SecondOpinion& second,
                                 const loop::ExplorerOptions& options);
// One line a movement.
std::string step_line(const loop::ExplorationStep& step);

}  // namespace tribench
