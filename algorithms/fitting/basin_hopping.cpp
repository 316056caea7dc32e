// SPDX-License-Identifier: MIT
#include "algorithms/fitting/basin_hopping.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

bool succeeded(const Minimum& minimum) { return minimum.status == MinimizeStatus::converged; }

// Metropolis: e^(-rise / temperature) against a uniform number, which is drawn in any case.
bool accepts(const Minimum& candidate, const Minimum& current, double temperature, double uniform) {
  const double rise = candidate.value - current.value;
  const double exponent = rise <= 0 ? 0 : temperature > 0 ? -rise / temperature : -HUGE_VAL;
  return elementary::exp(exponent) >= uniform && (succeeded(candidate) || !succeeded(current));
}

bool is_better(const Minimum& candidate, const Minimum& best, BestRule rule) {
  if (rule == BestRule::by_value) return candidate.value < best.value;
  return succeeded(candidate) && (candidate.value < best.value || !succeeded(best));
}

}  // namespace

Minimum basin_hopping(const LocalMinimizer& minimize, std::span<const double> start,
                      const BasinHoppingOptions& options, RandomStream random,
                      const std::function<void(const Minimum&)>& improved) {
  Minimum current = minimize(start);
  Minimum best = current;
  if (improved) improved(best);
  std::uint64_t evaluations = current.evaluations;
  double step = options.step;
  int accepted = 0;
  int since_best = 0;
  std::vector<double> x(start.size());
  for (int iteration = 1; iteration <= options.iterations; ++iteration) {
    if (options.stop != nullptr && *options.stop) break;
    if (options.patience > 0 && since_best >= options.patience) break;
    if (iteration % options.step_interval == 0) {
      const double rate = static_cast<double>(accepted) / iteration;
      step = rate > options.target_acceptance ? step / options.step_factor
                                              : step * options.step_factor;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double scale = options.scales.empty() ? 1 : options.scales[i];
      x[i] = current.x[i] + scale * random.uniform(-step, step);
    }
    const Minimum candidate = minimize(x);
    evaluations += candidate.evaluations;
    const bool accept = accepts(candidate, current, options.temperature, random.uniform());
    since_best += 1;
    if ((accept || options.best_rule == BestRule::by_value) &&
        is_better(candidate, best, options.best_rule)) {
      best = candidate;
      since_best = 0;
      if (improved) improved(best);
    }
    if (!accept) continue;
    accepted += 1;
    current = candidate;
  }
  best.evaluations = evaluations;
  return best;
}

}  // namespace tribench
