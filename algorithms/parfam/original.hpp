// SPDX-License-Identifier: MIT
//
// ParFam as published: every coefficient a parameter, relative 2-norm plus 1-norm, basin hopping
// over each family of the grid, then the ladder of cut-offs. Every default is the published one.
//
// Source: Scholl et al. 2023 and parfam 0.0.2 (train.py, config_files/wrapper). We differ in three
// things: NLopt's L-BFGS stands for PyTorch's in the pruning; random numbers are ours; functions
// and denominators that the operator set does not allow are not in the grid.
#pragma once

#include "algorithms/parfam/inner_search.hpp"
#include "algorithms/parfam/published_model.hpp"
#include "algorithms/regressor.hpp"

namespace tribench::parfam {

struct OriginalOptions {
  bool big = false;              // the grid of the Feynman experiments
  std::optional<Family> family;  // the only one that is tried, where given
  Optimizer optimizer = Optimizer::basin_hopping;
  int hops = 10;                   // maxiter1 / 10
  int iterations_per_input = 100;  // of BFGS
  double lambda = 1e-3;            // of the 1-norm
  double lambda_finetuning = 1e-5;
  std::size_t most_rows = 500;  // of the search
  std::size_t most_rows_finetuning = 5000;
  // Steps of the pruning's refits, with the evaluations that PyTorch's L-BFGS may use in each.
  int finetuning_steps = 50;
  int finetuning_step_evaluations = 25;
  double accuracy = 1e-3;  // validation error that ends the search early ...
  int most_active = 10;    // ... with fewer parameters above 0.01 than this
  std::uint64_t evaluations = 1'000'000;
};

// A pruned model replaces the best: a smaller error, or not much more with far fewer coefficients.
bool accepts_pruning(double error, double best_error, std::size_t active, std::size_t best_active);

// The cut-offs tried, each up to twice.
inline constexpr double kCutoffs[] = {1e-5, 1e-4, 1e-3, 1e-2};

FitResult search_as_published(FitContext& context, const OriginalOptions& options);

}  // namespace tribench::parfam
