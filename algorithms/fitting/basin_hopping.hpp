// SPDX-License-Identifier: MIT
//
// Basin hopping: Monte Carlo over local minima. Defaults are SciPy's.
//
// Source: Wales & Doye 1997; SciPy 1.15, scipy/optimize/_basinhopping.py. We differ in one
// default: the best minimum is the one of least value. SciPy keeps a minimum only where its local
// minimiser reported success, and so drops improvements that end in a precision loss; that rule is
// there as BestRule::scipy.
#pragma once

#include <span>
#include <vector>

#include "algorithms/fitting/objective.hpp"
#include "foundation/random.hpp"

namespace tribench {

enum class BestRule {
  by_value,
  scipy,  // accepted steps and successful minimisations only
};

struct BasinHoppingOptions {
  int iterations = 100;             // after the first local minimisation
  double temperature = 1.0;         // in the objective's unit; 0 accepts only improvements
  double step = 0.5;                // each coordinate moves by U(-step, step)
  std::vector<double> scales = {};  // per coordinate: multiplies step; empty means 1
  int step_interval = 50;           // the step adapts after so many iterations
  double target_acceptance = 0.5;
  double step_factor = 0.9;
  int patience = 0;  // stop after so many iterations without a new best; 0 never
  BestRule best_rule = BestRule::by_value;
  const bool* stop = nullptr;  // as in MinimizeOptions
};

// `improved` is told each new best; may be empty. The same stream gives the same result.
Minimum basin_hopping(const LocalMinimizer& minimize, std::span<const double> start,
                      const BasinHoppingOptions& options, RandomStream random,
                      const std::function<void(const Minimum&)>& improved = {});

}  // namespace tribench
