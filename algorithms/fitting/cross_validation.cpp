// SPDX-License-Identifier: MIT
#include "algorithms/fitting/cross_validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "algorithms/fitting/constant_fit.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// A single movement is cut into this many stretches, which take the movements' place.
constexpr std::size_t kStretches = 10;

// The units that are held out whole: movements, or stretches of the only one.
std::vector<int> units_of(std::span<const int> movement) {
  std::vector<int> units(movement.begin(), movement.end());
  if (std::ranges::adjacent_find(units, std::ranges::not_equal_to{}) != units.end()) return units;
  if (units.size() < 2 * kStretches) return units;
  for (std::size_t r = 0; r < units.size(); ++r) {
    units[r] = static_cast<int>(r * kStretches / units.size());
  }
  return units;
}

// Which fold each row belongs to: the units are dealt out in a fixed random order.
std::vector<int> folds_of(std::span<const int> movement, int folds) {
  const std::vector<int> units = units_of(movement);
  std::map<int, int> fold_of;
  for (const int unit : units) fold_of.emplace(unit, 0);
  std::vector<int> order;
  for (const auto& entry : fold_of) order.push_back(entry.first);
  RandomStream random(key_of("cross-validation folds"));
  random.shuffle(std::span(order));
  for (std::size_t i = 0; i < order.size(); ++i) {
    fold_of[order[i]] = static_cast<int>(i % static_cast<std::size_t>(folds));
  }
  std::vector<int> result;
  result.reserve(units.size());
  for (const int unit : units) result.push_back(fold_of[unit]);
  return result;
}

struct Rows {
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  std::vector<double> target;

  Inputs inputs() const { return {pointers, target.size()}; }
};

Rows select_rows(const Inputs& inputs, std::span<const double> target, std::span<const int> fold,
                 int which, bool inside) {
  Rows rows;
  rows.columns.resize(inputs.columns.size());
  for (std::size_t r = 0; r < target.size(); ++r) {
    if ((fold[r] == which) != inside) continue;
    for (std::size_t j = 0; j < rows.columns.size(); ++j) {
      rows.columns[j].push_back(inputs.columns[j][r]);
    }
    rows.target.push_back(target[r]);
  }
  for (const auto& column : rows.columns) rows.pointers.push_back(column.data());
  return rows;
}

double mean_square(Evaluator& evaluator, const Expression& formula, const Rows& rows) {
  std::vector<double> values(rows.target.size());
  evaluator.evaluate(formula, rows.inputs(), values);
  double sum = 0;
  for (std::size_t r = 0; r < values.size(); ++r) {
    const double error = rows.target[r] - values[r];
    sum += error * error;
  }
  return std::isfinite(sum) ? sum / static_cast<double>(values.size())
                            : std::numeric_limits<double>::infinity();
}

// errors[k][f]: held-out mean square of formula k in fold f.
std::size_t simplest_good(const std::vector<std::vector<double>>& errors,
                          std::span<const double> means, double tolerance) {
  const auto best = static_cast<std::size_t>(std::ranges::min_element(means) - means.begin());
  const auto folds = static_cast<double>(errors[best].size());
  for (std::size_t k = 0; k < best; ++k) {
    if (!std::isfinite(means[k])) continue;
    const double mean = means[k] - means[best];
    double variance = 0;
    for (std::size_t f = 0; f < errors[k].size(); ++f) {
      const double difference = errors[k][f] - errors[best][f] - mean;
      variance += difference * difference;
    }
    if (mean < tolerance * std::sqrt(variance / (folds * (folds - 1)))) return k;
  }
  return best;
}

}  // namespace

CrossValidation cross_validate(std::span<const Expression> formulas, const Inputs& inputs,
                               std::span<const double> target, std::span<const int> movement,
                               int folds, double tolerance) {
  CrossValidation result;
  result.chosen = formulas.size() - 1;
  const std::vector<int> fold = folds_of(movement, folds);
  const int used = target.empty() ? 0 : 1 + *std::ranges::max_element(fold);
  if (used < 2) return result;
  ConstantFitter fitter;
  Evaluator evaluator;
  std::vector<std::vector<double>> errors(formulas.size());
  for (int f = 0; f < used; ++f) {
    const Rows train = select_rows(inputs, target, fold, f, false);
    const Rows held_out = select_rows(inputs, target, fold, f, true);
    for (std::size_t k = 0; k < formulas.size(); ++k) {
      Expression formula = formulas[k];
      result.node_rows += fitter.fit(formula, train.inputs(), train.target).node_rows;
      errors[k].push_back(mean_square(evaluator, formula, held_out));
    }
  }
  for (const std::vector<double>& of_formula : errors) {
    double mean = 0;
    for (const double e : of_formula) mean += e / static_cast<double>(used);
    result.mean_square.push_back(mean);
  }
  result.chosen = simplest_good(errors, result.mean_square, tolerance);
  return result;
}

}  // namespace tribench
