// SPDX-License-Identifier: MIT
#include "algorithms/fitting/posterior_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/fitting/spread_rows.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr std::size_t kMostRows = 1000;
// Functions closer to each other than this share of the noise's square are the same.
constexpr double kSame = 1e-4;

double mean_square_between(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t r = 0; r < a.size(); ++r) sum += (a[r] - b[r]) * (a[r] - b[r]);
  return sum / static_cast<double>(a.size());
}

// Evaluates formulas on some of the rows, and counts.
class Sampler {
 public:
  explicit Sampler(const Inputs& inputs) : some_(inputs, kMostRows) {}

  std::vector<double> values_of(const Expression& formula) {
    const Inputs table = some_.table();
    std::vector<double> values(table.rows);
    evaluator_.evaluate(formula, table, values);
    node_rows_ += node_rows(formula, table.rows);
    return values;
  }
  std::uint64_t spent() const { return node_rows_; }

 private:
  SpreadRows some_;
  Evaluator evaluator_;
  std::uint64_t node_rows_ = 0;
};

bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

struct Posterior {
  std::vector<double> mean;  // empty where no formula of the pool is finite
  double spread = 0;
};

Posterior posterior_of(std::vector<WeighedFormula> pool, Sampler& sampler) {
  std::ranges::stable_sort(pool, {}, &WeighedFormula::against);
  std::vector<std::vector<double>> functions;
  std::vector<double> weights;
  Posterior result;
  double total = 0;
  for (const WeighedFormula& member : pool) {
    if (!(member.against - pool.front().against <= kNegligibleNats)) break;
    std::vector<double> values = sampler.values_of(*member.formula);
    const double same = kSame * pool.front().mean_square;
    if (!all_finite(values) || std::ranges::any_of(functions, [&](const auto& other) {
          return mean_square_between(values, other) <= same;
        })) {
      continue;
    }
    weights.push_back(elementary::exp(pool.front().against - member.against));
    total += weights.back();
    result.mean.resize(values.size(), 0.0);
    for (std::size_t r = 0; r < values.size(); ++r) result.mean[r] += weights.back() * values[r];
    functions.push_back(std::move(values));
  }
  for (double& value : result.mean) value /= total;
  for (std::size_t k = 0; k < functions.size(); ++k) {
    result.spread += weights[k] / total * mean_square_between(functions[k], result.mean);
  }
  return result;
}

}  // namespace

PosteriorDistances distances_from_posterior_mean(std::span<const Expression> candidates,
                                                 std::span<const WeighedFormula> pool,
                                                 const Inputs& inputs) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  PosteriorDistances result{std::vector<double>(candidates.size(), kInfinite), 0, 0};
  Sampler sampler(inputs);
  const Posterior posterior = posterior_of({pool.begin(), pool.end()}, sampler);
  result.spread = posterior.spread;
  for (std::size_t k = 0; k < candidates.size() && !posterior.mean.empty(); ++k) {
    const double distance = mean_square_between(sampler.values_of(candidates[k]), posterior.mean);
    if (std::isfinite(distance)) result.mean_square[k] = distance;
  }
  result.node_rows = sampler.spent();
  return result;
}

std::size_t simplest_typical(const PosteriorDistances& distances) {
  const std::vector<double>& all = distances.mean_square;
  const auto first =
      std::ranges::find_if(all, [&](double distance) { return distance <= distances.spread; });
  const auto chosen = first != all.end() ? first : std::ranges::min_element(all);
  return static_cast<std::size_t>(chosen - all.begin());
}

}  // namespace tribench
