// SPDX-License-Identifier: MIT
//
// Rates and ratios over many outcomes, each beside its target: what the tables of the study of the
// closed loop are written with. Private to the room.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/study/loop_figures.hpp"
#include "harness/study/loop_outcome.hpp"

namespace tribench {

class FigureTable {
 public:
  using Choice = std::function<bool(const LoopOutcome&)>;
  using Count = std::function<std::size_t(const LoopOutcome&)>;
  using Size = std::function<double(const LoopOutcome&)>;
  struct Target {
    double value;
    bool at_least;  // else at most
  };

  explicit FigureTable(const std::vector<LoopOutcome>& outcomes) : outcomes_(outcomes) {}

  // Of the chosen outcomes those that hit; nothing where none is chosen.
  void rate(const std::string& name, const Choice& among, const Choice& hit, Target target);
  // Hits and trials are sums of counts.
  void share(const std::string& name, const Choice& among, const Count& hit, const Count& trial,
             Target target);
  // factor times the sum of `above` over the sum of `below`.
  void ratio(const std::string& name, const Choice& among, const Size& above, const Size& below,
             double factor, Target target);

  std::vector<LoopFigure> figures;

 private:
  void add_rate(const std::string& name, std::size_t hits, std::size_t trials, Target target);

  const std::vector<LoopOutcome>& outcomes_;
};

}  // namespace tribench
