// SPDX-License-Identifier: MIT
#include "algorithms/parfam/pole_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/singularity.hpp"
#include "algorithms/fitting/ipopt_minimizer.hpp"
#include "algorithms/parfam/denominators.hpp"

namespace tribench::parfam {
namespace {

// What a denominator keeps from 0 at the points; its constant is 1.
constexpr double kLeast = 0.01;
// Less than asked for is enough for those who look: Ipopt meets a constraint to 1e-8.
constexpr double kAccepted = 0.99 * kLeast;
constexpr std::size_t kMostCorners = 256;
constexpr std::size_t kPointsARound = 6;
constexpr int kRounds = 3;
constexpr int kProofs = 6;
constexpr std::uint64_t kEvaluations = 60;
// Where denominators are shrunk towards 1 until they keep their distance.
constexpr double kShrink = 0.7;
constexpr int kMostShrinks = 40;

// The least denominator at a point; minus infinity where one is not a number.
double least_denominator(const Structure& structure, std::span<const double> inner,
                         std::span<const double> point, std::vector<double>& values) {
  values.resize(count_denominators(structure));
  denominators_at(structure, inner, point, values, {});
  double least = std::numeric_limits<double>::infinity();
  for (double value : values) {
    least =
        std::min(least, std::isfinite(value) ? value : -std::numeric_limits<double>::infinity());
  }
  return least;
}

bool keeps_distance(const Structure& structure, std::span<const double> inner,
                    const std::vector<std::vector<double>>& points) {
  std::vector<double> values;
  return std::ranges::all_of(points, [&](const std::vector<double>& point) {
    return least_denominator(structure, inner, point, values) >= kAccepted;
  });
}

// Brings all denominators nearer to 1.
void shrink_once(const Structure& structure, std::vector<double>& inner) {
  std::size_t k = 0;
  const auto nearer = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) inner[k++] *= kShrink;
  };
  for (std::size_t i = 0; i < structure.functions.size(); ++i) {
    k += structure.numerators[i].size();
    nearer(structure.denominators[i].size());
  }
  nearer(structure.out_denominator.size());
}

// ... until they keep their distance at the points.
void shrink(const Structure& structure, const std::vector<std::vector<double>>& points,
            std::vector<double>& inner) {
  for (int i = 0; i < kMostShrinks && !keeps_distance(structure, inner, points); ++i) {
    shrink_once(structure, inner);
  }
}

Constraints constraints_at(const Structure& structure, const std::vector<std::vector<double>>& at) {
  const std::size_t count = count_denominators(structure);
  Constraints constraints;
  constraints.low.assign(count * at.size(), kLeast);
  constraints.high.assign(count * at.size(), std::numeric_limits<double>::infinity());
  constraints.evaluate = [&structure, &at, count](std::span<const double> x,
                                                  std::span<double> values,
                                                  std::span<double> jacobian) {
    const std::size_t block = count * x.size();
    for (std::size_t p = 0; p < at.size(); ++p) {
      denominators_at(structure, x, at[p], values.subspan(p * count, count),
                      jacobian.empty() ? jacobian : jacobian.subspan(p * block, block));
    }
  };
  return constraints;
}

}  // namespace

PoleGuard::PoleGuard(std::span<const Input> inputs, std::span<const double> scales,
                     std::span<const double* const> columns, std::size_t rows,
                     const OperatorSet& operators)
    : box_(input_box(inputs)),
      scales_(scales.begin(), scales.end()),
      columns_(columns.begin(), columns.end()),
      rows_(rows),
      operators_(operators) {
  corners_.emplace_back(box_.size(), 0.0);
  for (std::size_t j = 0; j < box_.size(); ++j) {
    if (box_[j].sign_of) continue;
    Points more;
    for (const std::vector<double>& corner : corners_) {
      for (const double value : {box_[j].low, box_[j].high}) {
        more.push_back(corner);
        more.back()[j] = value / scales_[j];
      }
    }
    if (more.size() > kMostCorners) break;
    corners_ = std::move(more);
  }
  for (std::vector<double>& corner : corners_) {
    for (std::size_t j = 0; j < box_.size(); ++j) {
      if (!box_[j].sign_of) continue;
      const double owner = corner[*box_[j].sign_of];
      corner[j] = (static_cast<double>(owner > 0) - static_cast<double>(owner < 0)) / scales_[j];
    }
  }
}

// The rows with the lowest denominators; none where all keep their distance.
PoleGuard::Points PoleGuard::lowest(const Structure& structure,
                                    std::span<const double> inner) const {
  std::vector<std::pair<double, std::vector<double>>> low;
  std::vector<double> values;
  std::vector<double> row(columns_.size());
  for (std::size_t r = 0; r < rows_; ++r) {
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = columns_[j][r];
    const double least = least_denominator(structure, inner, row, values);
    if (!(least >= kAccepted)) low.emplace_back(least, row);
  }
  std::ranges::stable_sort(low, {}, [](const auto& entry) { return entry.first; });
  Points result;
  for (std::size_t i = 0; i < std::min(low.size(), kPointsARound); ++i) {
    result.push_back(std::move(low[i].second));
  }
  return result;
}

void PoleGuard::clear_at(Projection& projection, std::vector<double>& inner, Points& points,
                         Budget& budget) const {
  const Structure& structure = projection.structure();
  bool stop = false;
  const Objective objective = projected_objective(projection, budget, stop);
  MinimizeOptions settings;
  settings.max_evaluations = kEvaluations;
  settings.value_tolerance = 1e-6;
  settings.stop = &stop;
  for (int round = 0; round < kRounds && !budget.exhausted(); ++round) {
    const Points low = lowest(structure, inner);
    points.insert(points.end(), low.begin(), low.end());
    if (keeps_distance(structure, inner, points)) return;
    shrink(structure, points, inner);
    const Constraints constraints = constraints_at(structure, points);
    inner = minimize_ipopt(objective, inner, {}, constraints, settings).x;
  }
  const Points low = lowest(structure, inner);
  points.insert(points.end(), low.begin(), low.end());
  shrink(structure, points, inner);
}

void PoleGuard::clear(Projection& projection, std::vector<double>& inner, Budget& budget) const {
  if (count_denominators(projection.structure()) == 0) return;
  Points points = corners_;
  clear_at(projection, inner, points, budget);
}

bool PoleGuard::make_proved(TrainedModel& model, std::span<const double> y, Budget& budget) const {
  Projection projection(model.structure, columns_, y, Denominators::constrained, budget);
  Points points = corners_;
  for (int i = 0; i < kProofs; ++i) {
    clear_at(projection, model.inner, points, budget);
    model.sum_squares = projection.sum_squares(model.inner);
    if (!std::isfinite(model.sum_squares)) return false;
    model.coefficients.assign(projection.coefficients().begin(), projection.coefficients().end());
    const SingularityResult result =
        prove_free(formula_of(model, scales_, Denominators::constrained, operators_), box_);
    if (result.verdict == Verdict::proved_free) return true;
    if (!result.witness) return false;
    std::vector<double> point = result.witness->point;
    for (std::size_t j = 0; j < point.size(); ++j) point[j] /= scales_[j];
    std::vector<double> values;
    if (least_denominator(model.structure, model.inner, point, values) >= kLeast) return false;
    points.push_back(std::move(point));
  }
  return false;
}

}  // namespace tribench::parfam
