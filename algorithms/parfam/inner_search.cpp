// SPDX-License-Identifier: MIT
#include "algorithms/parfam/inner_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algorithms/fitting/basin_hopping.hpp"
#include "algorithms/fitting/ipopt_minimizer.hpp"
#include "algorithms/fitting/nlopt_minimizer.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"

namespace tribench::parfam {
namespace {

constexpr int kLocalIterations = 40;
constexpr double kSameValue = 1e-4;  // relative: two starts reached the same minimum
constexpr double kBox = 5;           // of a global search, in the scaled units

constexpr std::uint64_t kHopEvaluations = 200;
constexpr int kIpoptStarts = 4;  // each costs as much as some thirty of the others
constexpr std::uint64_t kIpoptEvaluations = 150;

constexpr std::array<std::string_view, 8> kNames = {
    "multi_start", "basin_hopping", "mlsl", "crs2", "esch", "isres", "direct_l", "ipopt"};

std::vector<double> random_start(std::size_t n, RandomStream& random) {
  std::vector<double> start(n);
  for (double& value : start) value = random.normal();
  return start;
}

void keep_from_poles(Projection& projection, const InnerSearchOptions& options, Minimum& minimum,
                     Budget& budget) {
  if (options.guard == nullptr || !std::isfinite(minimum.value)) return;
  options.guard->clear(projection, minimum.x, budget);
  minimum.value = projection.sum_squares(minimum.x);
}

Minimum best_of_starts(Projection& projection, const InnerSearchOptions& options, Budget& budget,
                       RandomStream random) {
  LevenbergMarquardt minimizer;
  Minimum best;
  int agreements = 0;
  for (int i = 0; i < options.starts && agreements < options.agreements; ++i) {
    std::vector<double> x = random_start(projection.inner_parameters(), random);
    Minimum found;
    found.value = minimizer
                      .minimize(projection, x,
                                {.max_iterations = kLocalIterations, .function_tolerance = 1e-7})
                      .sum_squares;
    found.x = std::move(x);
    // A constraint never lowers a minimum.
    if (found.value < best.value) keep_from_poles(projection, options, found, budget);
    if (!std::isfinite(found.value)) continue;
    const bool same = std::abs(found.value - best.value) <= kSameValue * best.value;
    agreements = same ? agreements + 1 : found.value < best.value ? 1 : agreements;
    if (found.value < best.value) best = std::move(found);
  }
  return best;
}

Minimum best_of_ipopt(const Projection& projection, const InnerSearchOptions& options,
                      const Objective& objective, MinimizeOptions settings, RandomStream random) {
  settings.max_evaluations = kIpoptEvaluations;
  Minimum best;
  for (int i = 0; i < std::min(options.starts, kIpoptStarts); ++i) {
    const std::vector<double> start = random_start(projection.inner_parameters(), random);
    Minimum found = minimize_ipopt(objective, start, {}, {}, settings);
    if (found.value < best.value) best = std::move(found);
  }
  return best;
}

// Basin hopping on n / 2 ln SSE, the negative log-likelihood but for a constant: a temperature of 1
// is then on the loss' own scale, whatever the units and the noise. Steps are as large as the
// parameters of the first minimum.
Minimum hop(const Objective& objective, std::size_t rows, std::span<const double> start,
            const InnerSearchOptions& options, MinimizeOptions settings, RandomStream random) {
  settings.max_evaluations = kHopEvaluations;
  const LocalMinimizer local = [&](std::span<const double> x) {
    Minimum minimum = minimize_nlopt(NloptMethod::lbfgs, objective, x, {}, settings);
    minimum.value =
        0.5 * static_cast<double>(rows) * elementary::log(std::max(minimum.value, 1e-300));
    return minimum;
  };
  const Minimum first = local(start);
  BasinHoppingOptions hops;
  hops.iterations = options.starts;
  for (const double x : first.x) hops.scales.push_back(std::max(1.0, std::abs(x)));
  hops.stop = settings.stop;
  return basin_hopping(local, first.x, hops, random);
}

Minimum search_globally(Projection& projection, const InnerSearchOptions& options, Budget& budget,
                        RandomStream random) {
  bool stop = false;
  const Objective objective = projected_objective(projection, budget, stop);
  MinimizeOptions settings;
  settings.max_evaluations = static_cast<std::uint64_t>(options.evaluations);
  settings.value_tolerance = 1e-9;
  settings.seed = random.next() >> 33;
  settings.stop = &stop;
  if (options.optimizer == Optimizer::ipopt) {
    return best_of_ipopt(projection, options, objective, settings, random);
  }
  const std::size_t n = projection.inner_parameters();
  const std::vector<double> start = random_start(n, random);
  if (options.optimizer != Optimizer::basin_hopping) {
    const Bounds box{std::vector<double>(n, -kBox), std::vector<double>(n, kBox)};
    return minimize_nlopt(nlopt_method(options.optimizer), objective, start, box, settings);
  }
  settings.stop = &stop;
  Minimum found = hop(objective, projection.rows(), start, options, settings, random);
  found.value = projection.sum_squares(found.x);
  return found;
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
    best = best_of_starts(projection, options, budget, random);
  } else {
    best = search_globally(projection, options, budget, random);
    keep_from_poles(projection, options, best, budget);
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
