// SPDX-License-Identifier: MIT
#include "algorithms/model_based/bounded_stribeck.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/fitting/ipopt_minimizer.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

// Grid over (vs, delta): vs evenly in its logarithm down to this share of the highest speed, which
// is 1 here.
constexpr double kLeastVelocityShare = 1e-3;
constexpr double kLeastExponent = 0.5;
constexpr double kMostExponent = 4;
constexpr std::size_t kVelocities = 24;
constexpr std::size_t kExponents = 10;
// Two branches that share a parameter are searched together, over pairs of a coarser grid.
constexpr std::size_t kPairVelocities = 10;
constexpr std::size_t kPairExponents = 5;
// The best points of the grid, each refined so often on a grid of 5 x 5 that shrinks by half.
constexpr std::size_t kRefined = 4;
constexpr int kRefinements = 16;
// A pass over the rows costs about as much as a formula of so many nodes.
constexpr std::uint64_t kPassNodes = 15;

struct Shape {
  double log_velocity = 0;
  double exponent = 1;
};

// A column of the linear problem as the search sees it: products with everything else.
struct Candidate {
  Shape shape;
  std::vector<double> with_fixed;
  double with_itself = 0;
  double with_target = 0;
};

// Rows whose columns have 1 as their largest magnitude, and the way back.
class NormalisedRows {
 public:
  explicit NormalisedRows(const StribeckRows& rows)
      : rows_(rows),
        velocity_(normalise(rows_.velocity)),
        acceleration_(normalise(rows_.acceleration)),
        target_(normalise(rows_.target)) {}

  const StribeckRows& rows() const { return rows_; }
  StribeckModel in_their_units(StribeckModel model) const;

 private:
  static double normalise(std::vector<double>& column);

  StribeckRows rows_;
  double velocity_;
  double acceleration_;
  double target_;
};

double NormalisedRows::normalise(std::vector<double>& column) {
  double largest = 0;
  for (const double x : column) largest = std::max(largest, std::abs(x));
  if (largest == 0) return 1;
  for (double& x : column) x /= largest;
  return largest;
}

StribeckModel NormalisedRows::in_their_units(StribeckModel model) const {
  for (StribeckBranch& branch : model.branches) {
    branch.coulomb *= target_;
    branch.breakaway_excess *= target_;
    branch.stribeck_velocity *= velocity_;
    branch.viscous *= target_ / velocity_;
  }
  model.offset *= target_;
  model.inertia *= target_ / acceleration_;
  return model;
}

// For normalised rows.
class ShapeSearch {
 public:
  ShapeSearch(const StribeckRows& rows, const StribeckModel& model, Budget& budget)
      : rows_(rows), model_(model), budget_(budget) {
    make_fixed_columns();
    take_apart_by_branch();
  }

  // The best shapes found, one a branch, and their linear parameters, written into `model`.
  double run(StribeckModel& model);

 private:
  void make_fixed_columns();
  void take_apart_by_branch();
  Candidate make_candidate(std::size_t branch, const Shape& shape);
  std::vector<Candidate> make_grid(std::size_t branch, std::size_t velocities,
                                   std::size_t exponents);
  double solve(std::span<const Candidate* const> chosen, std::vector<double>& solution) const;
  void refine(std::vector<Candidate>& chosen, double& best);
  void write(std::span<const Candidate> chosen, StribeckModel& model) const;
  std::size_t branches() const { return model_.branches.size(); }
  double low_log() const { return elementary::log(kLeastVelocityShare); }
  double high_log() const { return 0; }

  const StribeckRows& rows_;
  const StribeckModel& model_;
  Budget& budget_;
  std::vector<std::vector<double>> fixed_;  // per branch sign and v; then offset and a
  std::vector<double> fixed_products_;
  std::vector<double> fixed_target_;
  double target_squares_ = 0;
  std::vector<std::vector<std::size_t>> rows_of_;  // by branch
  std::vector<std::vector<double>> speeds_;        // of these rows
  bool stopped_ = false;
};

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void ShapeSearch::make_fixed_columns() {
  const std::size_t n = rows_.size();
  for (std::size_t branch = 0; branch < branches(); ++branch) {
    fixed_.emplace_back(n, 0.0);
    fixed_.emplace_back(n, 0.0);
    for (std::size_t row = 0; row < n; ++row) {
      if (rows_.branch[row] != branch) continue;
      fixed_[2 * branch][row] = rows_.sign[row];
      fixed_[2 * branch + 1][row] = rows_.velocity[row];
    }
  }
  if (model_.has_offset) fixed_.emplace_back(n, 1.0);
  if (model_.has_inertia) fixed_.push_back(rows_.acceleration);
  for (const auto& a : fixed_) {
    for (const auto& b : fixed_) fixed_products_.push_back(dot(a, b));
    fixed_target_.push_back(dot(a, rows_.target));
  }
  target_squares_ = dot(rows_.target, rows_.target);
}

void ShapeSearch::take_apart_by_branch() {
  rows_of_.resize(branches());
  speeds_.resize(branches());
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    rows_of_[rows_.branch[row]].push_back(row);
    speeds_[rows_.branch[row]].push_back(std::abs(rows_.velocity[row]));
  }
}

Candidate ShapeSearch::make_candidate(std::size_t branch, const Shape& shape) {
  Candidate candidate{shape, std::vector<double>(fixed_.size(), 0.0)};
  if (!budget_.spend(kPassNodes * rows_.size())) {
    stopped_ = true;
    return candidate;
  }
  std::vector<double> decays = speeds_[branch];
  decay_of_each(decays, elementary::exp(shape.log_velocity), shape.exponent);
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const std::size_t row = rows_of_[branch][i];
    const double value = rows_.sign[row] * decays[i];
    candidate.with_itself += value * value;
    candidate.with_target += value * rows_.target[row];
    for (std::size_t k = 0; k < fixed_.size(); ++k) {
      candidate.with_fixed[k] += value * fixed_[k][row];
    }
  }
  return candidate;
}

std::vector<Candidate> ShapeSearch::make_grid(std::size_t branch, std::size_t velocities,
                                              std::size_t exponents) {
  std::vector<Candidate> grid;
  for (std::size_t i = 0; i < velocities; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(velocities - 1);
    for (std::size_t j = 0; j < exponents; ++j) {
      const double exponent = kLeastExponent + (kMostExponent - kLeastExponent) *
                                                   static_cast<double>(j) /
                                                   static_cast<double>(exponents - 1);
      const Shape shape{low_log() + share * (high_log() - low_log()), exponent};
      grid.push_back(make_candidate(branch, shape));
      if (stopped_) {
        grid.pop_back();
        return grid;
      }
    }
  }
  return grid;
}

// Sum of squares at the best linear parameters: the fixed columns, then one decay a branch.
double ShapeSearch::solve(std::span<const Candidate* const> chosen,
                          std::vector<double>& solution) const {
  const std::size_t fixed = fixed_.size();
  const std::size_t n = fixed + chosen.size();
  std::vector<double> a(n * n, 0.0);
  std::vector<double> b(n);
  std::vector<char> non_negative(n, 0);
  for (std::size_t i = 0; i < fixed; ++i) {
    for (std::size_t j = 0; j < fixed; ++j) a[i * n + j] = fixed_products_[i * fixed + j];
    b[i] = fixed_target_[i];
  }
  for (std::size_t branch = 0; branch < chosen.size(); ++branch) {
    const Candidate& candidate = *chosen[branch];
    const std::size_t k = fixed + branch;
    for (std::size_t i = 0; i < fixed; ++i) {
      a[i * n + k] = candidate.with_fixed[i];
      a[k * n + i] = candidate.with_fixed[i];
    }
    a[k * n + k] = candidate.with_itself;
    b[k] = candidate.with_target;
    non_negative[k] = 1;
    non_negative[2 * branch] = 1;
  }
  solution.resize(n);
  if (!solve_quadratic(a, b, non_negative, solution)) {
    return std::numeric_limits<double>::infinity();
  }
  double value = target_squares_;
  for (std::size_t i = 0; i < n; ++i) {
    double row = 0;
    for (std::size_t j = 0; j < n; ++j) row += a[i * n + j] * solution[j];
    value += solution[i] * (row - 2 * b[i]);
  }
  return value;
}

// Walks downhill from the chosen shapes, one branch after the other, on grids of 5 x 5 points.
void ShapeSearch::refine(std::vector<Candidate>& chosen, double& best) {
  double velocity_step = (high_log() - low_log()) / (kVelocities - 1);
  double exponent_step = (kMostExponent - kLeastExponent) / (kExponents - 1);
  std::vector<double> solution;
  for (int round = 0; round < kRefinements && !stopped_; ++round) {
    for (std::size_t branch = 0; branch < branches(); ++branch) {
      const Shape centre = chosen[branch].shape;
      for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
          const Shape shape{
              std::clamp(centre.log_velocity + 0.5 * i * velocity_step, low_log(), high_log()),
              std::clamp(centre.exponent + 0.5 * j * exponent_step, kLeastExponent, kMostExponent)};
          const Candidate trial = make_candidate(branch, shape);
          if (stopped_) return;
          std::vector<const Candidate*> all;
          for (const Candidate& candidate : chosen) all.push_back(&candidate);
          all[branch] = &trial;
          const double value = solve(all, solution);
          if (!(value < best)) continue;
          best = value;
          chosen[branch] = trial;
        }
      }
    }
    velocity_step *= 0.5;
    exponent_step *= 0.5;
  }
}

void ShapeSearch::write(std::span<const Candidate> chosen, StribeckModel& model) const {
  std::vector<const Candidate*> all;
  for (const Candidate& candidate : chosen) all.push_back(&candidate);
  std::vector<double> solution;
  solve(all, solution);
  for (std::size_t branch = 0; branch < branches(); ++branch) {
    model.branches[branch] = {solution[2 * branch], solution[fixed_.size() + branch],
                              std::min(elementary::exp(chosen[branch].shape.log_velocity), 1.0),
                              chosen[branch].shape.exponent, solution[2 * branch + 1]};
  }
  std::size_t next = 2 * branches();
  if (model.has_offset) model.offset = solution[next++];
  if (model.has_inertia) model.inertia = solution[next];
}

double ShapeSearch::run(StribeckModel& model) {
  const bool pairs = branches() == 2;
  std::vector<std::vector<Candidate>> grids;
  for (std::size_t branch = 0; branch < branches(); ++branch) {
    grids.push_back(make_grid(branch, pairs ? kPairVelocities : kVelocities,
                              pairs ? kPairExponents : kExponents));
    if (grids.back().empty()) return std::numeric_limits<double>::infinity();
  }
  struct Place {
    double value;
    std::size_t first;
    std::size_t second;
  };
  std::vector<Place> places;
  std::vector<double> solution;
  for (std::size_t i = 0; i < grids[0].size(); ++i) {
    for (std::size_t j = 0; j < (pairs ? grids[1].size() : 1); ++j) {
      std::vector<const Candidate*> chosen = {&grids[0][i]};
      if (pairs) chosen.push_back(&grids[1][j]);
      places.push_back({solve(chosen, solution), i, j});
    }
  }
  const std::size_t refined = std::min(kRefined, places.size());
  std::ranges::partial_sort(places, places.begin() + static_cast<std::ptrdiff_t>(refined), {},
                            &Place::value);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < refined; ++k) {
    std::vector<Candidate> chosen = {grids[0][places[k].first]};
    if (pairs) chosen.push_back(grids[1][places[k].second]);
    double value = places[k].value;
    refine(chosen, value);
    if (!(value < best)) continue;
    best = value;
    write(chosen, model);
  }
  return best;
}

// All parameters together under the physical constraints.
void polish(const StribeckRows& rows, StribeckModel& model, Budget& budget, StribeckFit& fit) {
  const BranchRanges ranges = physical_ranges(rows);
  constexpr ConstantRange kAny;
  Bounds bounds;
  const auto add = [&](const ConstantRange& range) {
    bounds.low.push_back(range.low);
    bounds.high.push_back(range.high);
  };
  for (std::size_t i = 0; i < model.branches.size(); ++i) {
    for (const ConstantRange& range : {ranges.coulomb, ranges.breakaway_excess,
                                       ranges.stribeck_velocity, ranges.exponent, kAny}) {
      add(range);
    }
  }
  while (bounds.low.size() < model.parameter_count()) add(kAny);
  bool stop = false;
  StribeckModel trial = model;
  const Objective objective = mean_squares(trial, rows, budget, 2 * kPassNodes, stop);
  MinimizeOptions options;
  options.max_evaluations = 300;
  options.stop = &stop;
  const Minimum minimum = minimize_ipopt(objective, model.parameters(), bounds, {}, options);
  fit.out_of_budget = fit.out_of_budget || stop;
  trial.set_parameters(minimum.x);
  const double value = trial.sum_squares(rows, {});
  if (!(value < fit.sum_squares)) return;
  fit.sum_squares = value;
  model = trial;
}

// The rows of one branch, as a problem of its own.
StribeckRows rows_of_branch(const StribeckRows& rows, std::size_t branch) {
  StribeckRows part;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows.branch[row] != branch) continue;
    part.velocity.push_back(rows.velocity[row]);
    part.sign.push_back(rows.sign[row]);
    part.target.push_back(rows.target[row]);
    part.branch.push_back(0);
  }
  return part;
}

StribeckFit fit_together(const StribeckRows& rows, StribeckModel& model, Budget& budget) {
  StribeckFit fit;
  if (rows.size() == 0) return fit;
  const NormalisedRows normalised(rows);
  const double found = ShapeSearch(normalised.rows(), model, budget).run(model);
  fit.out_of_budget = budget.exhausted();
  fit.sum_squares = model.sum_squares(normalised.rows(), {});
  if (std::isfinite(found) && !fit.out_of_budget) polish(normalised.rows(), model, budget, fit);
  model = normalised.in_their_units(model);
  fit.sum_squares = model.sum_squares(rows, {});
  return fit;
}

}  // namespace

BranchRanges physical_ranges(const StribeckRows& rows) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double highest = 0;
  for (const double v : rows.velocity) highest = std::max(highest, std::abs(v));
  if (highest == 0) highest = 1;
  return {{0, kInfinity},
          {0, kInfinity},
          {highest * kLeastVelocityShare, highest},
          {kLeastExponent, kMostExponent}};
}

StribeckFit fit_bounded_stribeck(const StribeckRows& rows, StribeckModel& model, Budget& budget) {
  const bool shares_parameters = model.has_offset || model.has_inertia;
  if (model.branches.size() == 1 || shares_parameters) return fit_together(rows, model, budget);
  // Without a common parameter each direction is a problem of its own.
  StribeckFit fit;
  for (std::size_t branch = 0; branch < model.branches.size(); ++branch) {
    StribeckModel part;
    part.branches.resize(1);
    const StribeckFit one = fit_together(rows_of_branch(rows, branch), part, budget);
    fit.sum_squares += one.sum_squares;
    fit.out_of_budget = fit.out_of_budget || one.out_of_budget;
    model.branches[branch] = part.branches[0];
  }
  return fit;
}

}  // namespace tribench
