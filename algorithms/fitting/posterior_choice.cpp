// SPDX-License-Identifier: MIT
#include "algorithms/fitting/posterior_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tribench {
namespace {

constexpr double kHeard = 15;  // nats from the best
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
  explicit Sampler(const Inputs& inputs) {
    const std::size_t kept = std::min(inputs.rows, kMostRows);
    for (const double* column : inputs.columns) {
      std::vector<double> values(kept);
      for (std::size_t k = 0; k < kept; ++k) values[k] = column[k * inputs.rows / kept];
      columns_.push_back(std::move(values));
    }
    for (const std::vector<double>& column : columns_) pointers_.push_back(column.data());
    rows_ = kept;
  }

  std::vector<double> values_of(const Expression& formula) {
    std::vector<double> values(rows_);
    evaluator_.evaluate(formula, {pointers_, rows_}, values);
    node_rows_ += node_rows(formula, rows_);
    return values;
  }
  std::uint64_t spent() const { return node_rows_; }
  std::size_t rows() const { return rows_; }

 private:
  std::vector<std::vector<double>> columns_;
  std::vector<const double*> pointers_;
  std::size_t rows_ = 0;
  Evaluator evaluator_;
  std::uint64_t node_rows_ = 0;
};

bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

// Values of the posterior mean; empty where no formula of the pool is finite.
std::vector<double> posterior_mean(std::vector<WeighedFormula> pool, Sampler& sampler) {
  std::ranges::stable_sort(pool, {}, &WeighedFormula::against);
  std::vector<std::vector<double>> functions;
  std::vector<double> mean;
  double total = 0;
  for (const WeighedFormula& member : pool) {
    if (!(member.against - pool.front().against <= kHeard)) break;
    std::vector<double> values = sampler.values_of(*member.formula);
    const double same = kSame * pool.front().mean_square;
    if (!all_finite(values) || std::ranges::any_of(functions, [&](const auto& other) {
          return mean_square_between(values, other) <= same;
        })) {
      continue;
    }
    const double weight = std::exp(pool.front().against - member.against);
    mean.resize(values.size(), 0.0);
    for (std::size_t r = 0; r < values.size(); ++r) mean[r] += weight * values[r];
    total += weight;
    functions.push_back(std::move(values));
  }
  for (double& value : mean) value /= total;
  return mean;
}

}  // namespace

PosteriorDistances distances_from_posterior_mean(std::span<const Expression> candidates,
                                                 std::span<const WeighedFormula> pool,
                                                 const Inputs& inputs) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  PosteriorDistances result{std::vector<double>(candidates.size(), kInfinite), 0};
  Sampler sampler(inputs);
  const std::vector<double> mean = posterior_mean({pool.begin(), pool.end()}, sampler);
  for (std::size_t k = 0; k < candidates.size() && !mean.empty(); ++k) {
    const double distance = mean_square_between(sampler.values_of(candidates[k]), mean);
    if (std::isfinite(distance)) result.mean_square[k] = distance;
  }
  result.node_rows = sampler.spent();
  return result;
}

}  // namespace tribench
