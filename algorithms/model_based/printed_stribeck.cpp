// SPDX-License-Identifier: MIT
#include "algorithms/model_based/printed_stribeck.hpp"

#include <limits>

#include "algorithms/fitting/basin_hopping.hpp"
#include "algorithms/fitting/nlopt_minimizer.hpp"

namespace tribench {
namespace {

constexpr double kHighestStart = 100;
constexpr std::uint64_t kIterationsPerParameter = 200;  // SciPy's BFGS
constexpr std::uint64_t kPassNodes = 30;                // value and gradient

}  // namespace

StribeckFit fit_printed_stribeck(const StribeckRows& rows, StribeckModel& model, Budget& budget,
                                 const RandomStream& random) {
  bool stop = false;
  StribeckModel trial = model;
  const double scale = 1 / static_cast<double>(rows.size());
  const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
    if (!budget.spend(kPassNodes * rows.size())) {
      stop = true;
      return std::numeric_limits<double>::quiet_NaN();
    }
    trial.set_parameters(x);
    const double value = trial.sum_squares(rows, gradient);
    for (double& g : gradient) g *= scale;
    return value * scale;
  };
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
