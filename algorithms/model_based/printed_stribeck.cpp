// SPDX-License-Identifier: MIT
#include "algorithms/model_based/printed_stribeck.hpp"

#include "algorithms/fitting/basin_hopping.hpp"
#include "algorithms/fitting/nlopt_minimizer.hpp"

namespace tribench {
namespace {

constexpr double kHighestStart = 100;
constexpr std::uint64_t kIterationsPerParameter = 200;  // SciPy's BFGS
constexpr std::uint64_t kGradientNodes = 30;            // value and gradient

}  // namespace

StribeckFit fit_printed_stribeck(const StribeckRows& rows, StribeckModel& model, Budget& budget,
                                 const RandomStream& random) {
  bool stop = false;
  StribeckModel trial = model;
  const Objective objective = mean_squares(trial, rows, budget, kGradientNodes, stop);
  MinimizeOptions local;
  local.max_evaluations = kIterationsPerParameter * model.parameter_count();
  local.stop = &stop;
  const LocalMinimizer minimize = [&](std::span<const double> start) {
    return minimize_nlopt(NloptMethod::lbfgs, objective, start, {}, local);
  };
  RandomStream starts = random.split("start");
  std::vector<double> start(model.parameter_count());
  for (double& value : start) value = starts.uniform(0, kHighestStart);
  BasinHoppingOptions options;
  options.best_rule = BestRule::scipy;
  options.stop = &stop;
  const Minimum minimum = basin_hopping(minimize, start, options, random.split("hops"));
  model.set_parameters(minimum.x);
  return {model.sum_squares(rows, {}), stop};
}

}  // namespace tribench
