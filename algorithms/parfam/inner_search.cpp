// SPDX-License-Identifier: MIT
#include "algorithms/parfam/inner_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algorithms/fitting/basin_hopping.hpp"
#include "algorithms/fitting/nlopt_minimizer.hpp"
#include "foundation/error.hpp"

namespace tribench::parfam {
namespace {

constexpr int kLocalIterations = 40;
constexpr double kSameValue = 1e-4;  // relative: two starts reached the same minimum
constexpr double kBox = 5;           // of a global search, in the scaled units

constexpr std::array<std::string_view, 7> kNames = {
    "multi_start", "basin_hopping", "mlsl", "crs2", "esch", "isres", "direct_l"};

std::vector<double> random_start(std::size_t n, RandomStream& random) {
  std::vector<double> start(n);
  for (double& value : start) value = random.normal();
  return start;
}

Minimum best_of_starts(Projection& projection, const InnerSearchOptions& options,
                       RandomStream random) {
  LevenbergMarquardt minimizer;
  Minimum best;
  int agreements = 0;
  for (int i = 0; i < options.starts && agreements < options.agreements; ++i) {
    std::vector<double> x = random_start(projection.inner_parameters(), random);
    const LevenbergMarquardtResult result = minimizer.minimize(
        projection, x, {.max_iterations = kLocalIterations, .function_tolerance = 1e-7});
    if (!std::isfinite(result.sum_squares)) continue;
    const bool same = std::abs(result.sum_squares - best.value) <= kSameValue * best.value;
    agreements = same ? agreements + 1 : result.sum_squares < best.value ? 1 : agreements;
    if (!(result.sum_squares < best.value)) continue;
    best.x = x;
    best.value = result.sum_squares;
  }
  return best;
}

Minimum search_globally(Projection& projection, const InnerSearchOptions& options, Budget& budget,
                        RandomStream random) {
  NormalEquations sums;
  bool stop = false;
  const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
    const double value = projection.sum_squares(x);
    stop = budget.exhausted();
    if (gradient.empty() || !std::isfinite(value)) return value;
    projection.normal_equations(sums);
    for (std::size_t k = 0; k < gradient.size(); ++k) gradient[k] = 2 * sums.gradient[k];
    return value;
  };
  MinimizeOptions settings;
  settings.max_evaluations = static_cast<std::uint64_t>(options.evaluations);
  settings.value_tolerance = 1e-9;
  settings.seed = random.next() >> 33;
  settings.stop = &stop;
  const std::size_t n = projection.inner_parameters();
  const std::vector<double> start = random_start(n, random);
  if (options.optimizer != Optimizer::basin_hopping) {
    const Bounds box{std::vector<double>(n, -kBox), std::vector<double>(n, kBox)};
    return minimize_nlopt(nlopt_method(options.optimizer), objective, start, box, settings);
  }
  settings.max_evaluations = 200;
  const LocalMinimizer local = [&](std::span<const double> x) {
    return minimize_nlopt(NloptMethod::lbfgs, objective, x, {}, settings);
  };
  BasinHoppingOptions hops;
  hops.iterations = options.starts;
  hops.temperature = 0;  // on the scale of the loss: a hop counts if it improves
  hops.stop = &stop;
  return basin_hopping(local, start, hops, random);
}

}  // namespace

NloptMethod nlopt_method(Optimizer optimizer) {
  switch (optimizer) {
    case Optimizer::mlsl:
      return NloptMethod::mlsl;
    case Optimizer::crs2:
      return NloptMethod::crs2;
    case Optimizer::esch:
      return NloptMethod::esch;
    case Optimizer::isres:
      return NloptMethod::isres;
    default:
      return NloptMethod::direct_l;
  }
}

Optimizer find_optimizer(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) throw_bad_input("there is no such optimizer", {}, "see --help");
  return static_cast<Optimizer>(found - kNames.begin());
}

std::optional<TrainedModel> search_family(const Structure& structure,
                                          std::span<const double* const> inputs,
                                          std::span<const double> y,
                                          const InnerSearchOptions& options, Budget& budget,
                                          const RandomStream& random) {
  Projection projection(structure, inputs, y, options.denominators, budget);
  Minimum best;
  if (projection.inner_parameters() == 0) {
    best.value = projection.sum_squares({});
  } else if (options.optimizer == Optimizer::multi_start) {
    best = best_of_starts(projection, options, random);
  } else {
    best = search_globally(projection, options, budget, random);
  }
  if (!std::isfinite(best.value)) return std::nullopt;
  const double value = projection.sum_squares(best.x);
  if (!std::isfinite(value)) return std::nullopt;
  return TrainedModel{structure,
                      best.x,
                      {projection.coefficients().begin(), projection.coefficients().end()},
                      value};
}

}  // namespace tribench::parfam
