// SPDX-License-Identifier: MIT
#include "algorithms/parfam/elimination.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "algorithms/fitting/symmetric_system.hpp"

namespace tribench::parfam {
namespace {

constexpr int kRefitIterations = 15;
constexpr double kRidge = 1e-9;  // of the scaled curvature: directions that nothing determines
// The weakest parameters are tried, because Wald's estimate is a quadratic one.
constexpr std::size_t kTried = 3;
// Below this square of the t value nothing else is tried.
constexpr double kWorthless = 0.5;

// Parameters are numbered linear first, then inner, as joint_curvature has them.
std::size_t linear_count(const Structure& s) { return s.out_numerator.size(); }

// The list and place of an inner parameter.
struct Place {
  std::vector<Monomial>* list = nullptr;
  std::size_t index = 0;
  bool is_argument = false;  // of a function's numerator
};

Place find_inner(Structure& structure, std::size_t k) {
  for (std::size_t i = 0; i < structure.functions.size(); ++i) {
    if (k < structure.numerators[i].size()) return {&structure.numerators[i], k, true};
    k -= structure.numerators[i].size();
    if (k < structure.denominators[i].size()) return {&structure.denominators[i], k, false};
    k -= structure.denominators[i].size();
  }
  return {&structure.out_denominator, k, false};
}

bool uses_function(const std::vector<Monomial>& monomials, std::size_t place) {
  return std::ranges::any_of(monomials, [&](const Monomial& m) { return m[place] != 0; });
}

// Takes out functions that no monomial of the output uses any more.
void drop_unused_functions(TrainedModel& model) {
  Structure& s = model.structure;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < s.functions.size();) {
    const std::size_t size = s.numerators[i].size() + s.denominators[i].size();
    const std::size_t place = s.inputs + i;
    if (uses_function(s.out_numerator, place) || uses_function(s.out_denominator, place)) {
      begin += size;
      ++i;
      continue;
    }
    const auto first = model.inner.begin() + static_cast<std::ptrdiff_t>(begin);
    model.inner.erase(first, first + static_cast<std::ptrdiff_t>(size));
    const auto at = static_cast<std::ptrdiff_t>(i);
    s.functions.erase(s.functions.begin() + at);
    s.numerators.erase(s.numerators.begin() + at);
    s.denominators.erase(s.denominators.begin() + at);
    for (auto* list : {&s.out_numerator, &s.out_denominator}) {
      for (Monomial& m : *list) m.erase(m.begin() + static_cast<std::ptrdiff_t>(place));
    }
  }
}

TrainedModel without(const TrainedModel& model, std::size_t k) {
  TrainedModel reduced = model;
  const std::size_t linear = linear_count(model.structure);
  if (k < linear) {
    const auto at = static_cast<std::ptrdiff_t>(k);
    reduced.structure.out_numerator.erase(reduced.structure.out_numerator.begin() + at);
    reduced.coefficients.erase(reduced.coefficients.begin() + at);
    drop_unused_functions(reduced);
    return reduced;
  }
  const Place place = find_inner(reduced.structure, k - linear);
  place.list->erase(place.list->begin() + static_cast<std::ptrdiff_t>(place.index));
  reduced.inner.erase(reduced.inner.begin() + static_cast<std::ptrdiff_t>(k - linear));
  return reduced;
}

class Eliminator {
 public:
  Eliminator(std::span<const double* const> inputs, std::span<const double> y,
             Denominators denominators, const PoleGuard* guard, Budget& budget)
      : inputs_(inputs), y_(y), denominators_(denominators), guard_(guard), budget_(budget) {}

  // Fits the inner parameters from where they are; false where nothing finite comes of it.
  bool refit(TrainedModel& model, std::vector<double>* worth);
  bool may_go(TrainedModel& model, std::size_t k) const;

 private:
  std::vector<double> worth_of(const TrainedModel& model, Projection& projection) const;

  std::span<const double* const> inputs_;
  std::span<const double> y_;
  Denominators denominators_;
  const PoleGuard* guard_;
  Budget& budget_;
  LevenbergMarquardt minimizer_;
};

// The square of each parameter's t value: what its removal would cost in units of the noise, if
// the model were quadratic.
std::vector<double> Eliminator::worth_of(const TrainedModel& model, Projection& projection) const {
  const std::vector<double> curvature = projection.joint_curvature();
  const auto p = static_cast<Eigen::Index>(model.coefficients.size() + model.inner.size());
  Eigen::MatrixXd a = Eigen::Map<const Eigen::MatrixXd>(curvature.data(), p, p);
  Eigen::VectorXd scale(p);
  for (Eigen::Index k = 0; k < p; ++k) scale[k] = a(k, k) > 0 ? 1 / std::sqrt(a(k, k)) : 0;
  a = scale.asDiagonal() * a * scale.asDiagonal();
  for (Eigen::Index k = 0; k < p; ++k) a(k, k) += kRidge;
  // The scale of a root's argument is the scale of its coefficient: hold the largest part of it.
  std::size_t begin = model.coefficients.size();
  std::vector<Eigen::Index> held;
  for (std::size_t i = 0; i < model.structure.functions.size(); ++i) {
    const std::size_t size = model.structure.numerators[i].size();
    if (model.structure.functions[i] == Op::sqrt && size > 0) {
      const auto first =
          model.inner.begin() + static_cast<std::ptrdiff_t>(begin - model.coefficients.size());
      const auto largest =
          std::max_element(first, first + static_cast<std::ptrdiff_t>(size),
                           [](double x, double y) { return std::abs(x) < std::abs(y); });
      held.push_back(static_cast<Eigen::Index>(begin) + (largest - first));
    }
    begin += size + model.structure.denominators[i].size();
  }
  for (Eigen::Index k : held) {
    a.row(k).setZero();
    a.col(k).setZero();
    a(k, k) = 1;
  }
  const Eigen::MatrixXd inverse = inverse_symmetric(a);
  const double freedom =
      std::max<double>(1.0, static_cast<double>(y_.size()) - static_cast<double>(p));
  const double variance = std::max(model.sum_squares, 1e-300) / freedom;
  std::vector<double> worth(static_cast<std::size_t>(p));
  for (Eigen::Index k = 0; k < p; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double value = at < model.coefficients.size()
                             ? model.coefficients[at]
                             : model.inner[at - model.coefficients.size()];
    const double spread = inverse(k, k) * scale[k] * scale[k];
    worth[at] = spread > 0 ? value * value / (spread * variance) : 0;
  }
  for (Eigen::Index k : held)
    worth[static_cast<std::size_t>(k)] = std::numeric_limits<double>::infinity();
  return worth;
}

bool Eliminator::refit(TrainedModel& model, std::vector<double>* worth) {
  Projection projection(model.structure, inputs_, y_, denominators_, budget_);
  minimizer_.minimize(projection, model.inner,
                      {.max_iterations = kRefitIterations, .function_tolerance = 1e-8});
  if (guard_ != nullptr) guard_->clear(projection, model.inner, budget_);
  const double reached = projection.sum_squares(model.inner);
  if (!std::isfinite(reached)) return false;
  model.sum_squares = reached;
  model.coefficients.assign(projection.coefficients().begin(), projection.coefficients().end());
  if (worth != nullptr) *worth = worth_of(model, projection);
  return true;
}

// The last part of an argument stays: the function goes with its terms in the output.
bool Eliminator::may_go(TrainedModel& model, std::size_t k) const {
  const std::size_t linear = linear_count(model.structure);
  if (k < linear) return linear > 1;
  const Place place = find_inner(model.structure, k - linear);
  return !place.is_argument || place.list->size() > 1;
}

}  // namespace

std::vector<TrainedModel> eliminate(const TrainedModel& model,
                                    std::span<const double* const> inputs,
                                    std::span<const double> y, Denominators denominators,
                                    const PoleGuard* guard, Budget& budget) {
  Eliminator eliminator(inputs, y, denominators, guard, budget);
  std::vector<TrainedModel> path;
  TrainedModel current = model;
  std::vector<double> worth;
  while (eliminator.refit(current, &worth)) {
    path.push_back(current);
    // Without a function or a denominator it is a polynomial, which best subsets do better.
    if (current.structure.inner_parameters() + current.structure.out_denominator.size() == 0) break;
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < worth.size(); ++k) {
      if (eliminator.may_go(current, k)) order.push_back(k);
    }
    if (order.empty()) break;
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return worth[k]; });
    TrainedModel best;
    best.sum_squares = std::numeric_limits<double>::infinity();
    const std::size_t tried = worth[order[0]] < kWorthless ? 1 : std::min(kTried, order.size());
    for (std::size_t i = 0; i < tried; ++i) {
      TrainedModel trial = without(current, order[i]);
      if (tried > 1 && !eliminator.refit(trial, nullptr)) continue;
      if (tried == 1) trial.sum_squares = 0;
      if (trial.sum_squares < best.sum_squares) best = std::move(trial);
    }
    if (!std::isfinite(best.sum_squares)) break;
    current = std::move(best);
  }
  return path;
}

}  // namespace tribench::parfam
