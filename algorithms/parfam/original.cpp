// SPDX-License-Identifier: MIT
#include "algorithms/parfam/original.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/basin_hopping.hpp"
#include "algorithms/fitting/bfgs.hpp"
#include "algorithms/fitting/ipopt_minimizer.hpp"
#include "algorithms/fitting/nlopt_minimizer.hpp"
#include "algorithms/parfam/published_formula.hpp"

namespace tribench::parfam {
namespace {

constexpr double kActive = 0.01;  // a coefficient above it counts
constexpr double kTrainingShare = 0.8;
constexpr double kBox = 10;                  // of global optimisers, as its dual annealing has it
constexpr double kMoreError = 1.5;           // what pruning may cost ...
constexpr double kFewerCoefficients = 0.75;  // ... if it takes out so much

struct Rows {
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  std::vector<double> target;
};

Rows take_rows(const FiniteRows& data, std::span<const std::size_t> places) {
  Rows rows;
  for (const auto& column : data.columns) {
    rows.columns.emplace_back();
    for (std::size_t place : places) rows.columns.back().push_back(column[place]);
  }
  for (std::size_t place : places) rows.target.push_back(data.target[place]);
  for (const auto& column : rows.columns) rows.pointers.push_back(column.data());
  return rows;
}

struct Split {
  Rows training;
  Rows validation;
};

Split split_rows(const FiniteRows& data, std::size_t most_training, RandomStream random) {
  std::vector<std::size_t> places(data.rows());
  std::iota(places.begin(), places.end(), 0U);
  random.shuffle(std::span(places));
  const auto training = std::max<std::size_t>(
      1, static_cast<std::size_t>(kTrainingShare * static_cast<double>(places.size())));
  Split split;
  split.training = take_rows(data, std::span(places).first(std::min(training, most_training)));
  // A single row validates itself.
  split.validation = training < places.size() ? take_rows(data, std::span(places).subspan(training))
                                              : take_rows(data, places);
  return split;
}

// ||f - y|| / ||y - mean y||
double relative_error(const Structure& structure, std::span<const double> theta, const Rows& rows) {
  PublishedModel model(structure, rows.pointers, rows.target.size());
  const std::span<const double> f = model.evaluate(theta);
  double mean = 0;
  for (double y : rows.target) mean += y / static_cast<double>(rows.target.size());
  double error = 0;
  double spread = 0;
  for (std::size_t r = 0; r < f.size(); ++r) {
    error += (f[r] - rows.target[r]) * (f[r] - rows.target[r]);
    spread += (rows.target[r] - mean) * (rows.target[r] - mean);
  }
  return std::sqrt(error / std::max(spread, 1e-300));
}

std::size_t count_active(std::span<const double> theta, double above) {
  return static_cast<std::size_t>(
      std::ranges::count_if(theta, [&](double c) { return std::abs(c) > above; }));
}

struct Best {
  Structure structure;
  std::vector<double> theta;
  double error = std::numeric_limits<double>::infinity();
};

class PublishedSearch {
 public:
  PublishedSearch(FitContext& context, const OriginalOptions& options)
      : context_(context), options_(options), data_(context.data) {}

  FitResult run();

 private:
  std::vector<Family> grid() const;
  Minimum minimize(const Objective& objective, std::size_t parameters, RandomStream random);
  void try_family(const Family& family, const Split& split, RandomStream random);
  void finetune(RandomStream random);
  std::optional<std::vector<double>> refit(const std::vector<double>& theta,
                                           const std::vector<char>& kept, const Rows& rows);
  Objective objective_of(PublishedModel& model, const Rows& rows, double lambda);

  FitContext& context_;
  const OriginalOptions& options_;
  FiniteRows data_;
  Best best_;
  bool stop_ = false;
  std::uint64_t evaluations_ = 0;
};

std::vector<Family> PublishedSearch::grid() const {
  GridLimits limits = options_.big ? big_grid() : small_grid();
  std::erase_if(limits.base_functions, [&](Op op) { return !context_.operators.allows(op); });
  if (options_.family) return {*options_.family};
  if (!context_.operators.allows(Op::div)) {
    limits.degree_in_denominator = 0;
    limits.degree_out_denominator = 0;
  }
  return published_grid(limits);
}

Objective PublishedSearch::objective_of(PublishedModel& model, const Rows& rows, double lambda) {
  return [this, &model, &rows, lambda](std::span<const double> theta, std::span<double> gradient) {
    evaluations_ += 1;
    if (evaluations_ > options_.evaluations || !context_.budget.spend(model.cost())) {
      stop_ = true;
      return std::numeric_limits<double>::quiet_NaN();
    }
    return model.loss(theta, rows.target, lambda, gradient);
  };
}

Minimum PublishedSearch::minimize(const Objective& objective, std::size_t parameters,
                                  RandomStream random) {
  std::vector<double> start(parameters);
  for (double& value : start) value = random.normal();
  const int iterations = options_.iterations_per_input * static_cast<int>(data_.columns.size());
  if (options_.optimizer != Optimizer::basin_hopping &&
      options_.optimizer != Optimizer::multi_start) {
    MinimizeOptions settings;
    settings.max_evaluations = static_cast<std::uint64_t>(iterations * (options_.hops + 1));
    settings.value_tolerance = 1e-10;
    settings.seed = random.next() >> 33;
    settings.stop = &stop_;
    if (options_.optimizer == Optimizer::ipopt) {
      return minimize_ipopt(objective, start, {}, {}, settings);
    }
    const Bounds box{std::vector<double>(parameters, -kBox), std::vector<double>(parameters, kBox)};
    return minimize_nlopt(nlopt_method(options_.optimizer), objective, start, box, settings);
  }
  const LocalMinimizer local = [&](std::span<const double> x) {
    return minimize_bfgs(objective, x, {.max_iterations = iterations, .stop = &stop_});
  };
  if (options_.optimizer == Optimizer::multi_start) {
    Minimum best = local(start);
    for (int i = 0; i < options_.hops && !stop_; ++i) {
      for (double& value : start) value = random.normal();
      const Minimum next = local(start);
      if (next.value < best.value) best = next;
    }
    return best;
  }
  BasinHoppingOptions hops;
  hops.iterations = options_.hops;
  hops.best_rule = BestRule::scipy;
  hops.stop = &stop_;
  return basin_hopping(local, start, hops, random);
}

void PublishedSearch::try_family(const Family& family, const Split& split, RandomStream random) {
  const std::vector<int> caps(data_.columns.size(), kMaximalPotence);
  const Structure structure = make_structure(family, caps);
  PublishedModel model(structure, split.training.pointers, split.training.target.size());
  const Objective objective = objective_of(model, split.training, options_.lambda);
  const Minimum minimum = minimize(objective, structure.parameters(), random);
  // A family that the limits cut short is discarded, unless there is nothing else.
  if (stop_ && std::isfinite(best_.error)) return;
  const double error = relative_error(structure, minimum.x, split.validation);
  if (!(error < best_.error)) return;
  best_ = {structure, minimum.x, error};
  if (context_.progress != nullptr) {
    context_.progress->improved(error * error, context_.budget.spent());
  }
}

// Fits the coefficients that are kept; the others are 0.
std::optional<std::vector<double>> PublishedSearch::refit(const std::vector<double>& theta,
                                                          const std::vector<char>& kept,
                                                          const Rows& rows) {
  PublishedModel model(best_.structure, rows.pointers, rows.target.size());
  const Objective full = objective_of(model, rows, options_.lambda_finetuning);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (kept[k] != 0) places.push_back(k);
  }
  std::vector<double> all(theta.size(), 0.0);
  std::vector<double> all_gradient(theta.size());
  const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
    for (std::size_t i = 0; i < places.size(); ++i) all[places[i]] = x[i];
    const double value = full(all, all_gradient);
    for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] = all_gradient[places[i]];
    return value;
  };
  std::vector<double> start;
  for (std::size_t place : places) start.push_back(theta[place]);
  MinimizeOptions settings;
  settings.max_evaluations =
      static_cast<std::uint64_t>(options_.finetuning_steps * options_.finetuning_step_evaluations);
  settings.stop = &stop_;
  const Minimum minimum = minimize_nlopt(NloptMethod::lbfgs, objective, start, {}, settings);
  if (!std::isfinite(minimum.value)) return std::nullopt;
  for (std::size_t i = 0; i < places.size(); ++i) all[places[i]] = minimum.x[i];
  return all;
}

void PublishedSearch::finetune(RandomStream random) {
  const Split split = split_rows(data_, options_.most_rows_finetuning, random);
  std::vector<double>& best = best_.theta;
  double best_error = relative_error(best_.structure, best, split.validation);
  std::size_t best_active = count_active(best, 0);
  for (double cutoff : kCutoffs) {
    for (int pass = 0; pass < 2; ++pass) {
      std::vector<char> kept(best.size());
      for (std::size_t k = 0; k < best.size(); ++k) kept[k] = std::abs(best[k]) > cutoff ? 1 : 0;
      const auto active = static_cast<std::size_t>(std::ranges::count(kept, 1));
      if (active == best_active || active == 0 || stop_) break;
      const auto theta = refit(best, kept, split.training);
      if (!theta) break;
      const double error = relative_error(best_.structure, *theta, split.validation);
      if (!accepts_pruning(error, best_error, active, best_active)) break;
      best = *theta;
      best_error = error;
      best_active = active;
    }
  }
}

FitResult PublishedSearch::run() {
  if (data_.rows() == 0) return FitResult::unsupported("there is no row without missing values");
  if (options_.family && !is_within(*options_.family, context_.operators)) {
    return FitResult::unsupported("the operators do not have what the family needs");
  }
  if (std::ranges::all_of(data_.target, [](double y) { return y == 0; })) {
    return {{Expression::constant(0)}, 0, StopReason::converged, "the target is 0 throughout"};
  }
  const Split split = split_rows(data_, options_.most_rows, context_.random.split("split"));
  const std::vector<Family> families = grid();
  const RandomStream random = context_.random.split("families");
  std::size_t tried = 0;
  for (; tried < families.size() && !stop_; ++tried) {
    try_family(families[tried], split, random.split(tried));
    if (best_.error < options_.accuracy &&
        count_active(best_.theta, kActive) < static_cast<std::size_t>(options_.most_active)) {
      break;
    }
  }
  FitResult result;
  result.reason = stop_ ? StopReason::budget : StopReason::converged;
  if (!std::isfinite(best_.error)) return result;
  if (!stop_) finetune(context_.random.split("finetuning"));
  const Expression formula = published_formula(best_.structure, best_.theta, context_.operators);
  if (!context_.operators.admits(formula)) {
    result.note = "the best formula does not keep to the operators";
    return result;
  }
  result.front = {formula};
  result.note = fmt::format("{} families of {}, validation error {:.2g}",
                            std::min(tried + 1, families.size()), families.size(), best_.error);
  return result;
}

}  // namespace

bool accepts_pruning(double error, double best_error, std::size_t active, std::size_t best_active) {
  const bool fewer =
      static_cast<double>(active) < kFewerCoefficients * static_cast<double>(best_active);
  return error < best_error || (error < kMoreError * best_error && fewer);
}

FitResult search_as_published(FitContext& context, const OriginalOptions& options) {
  return PublishedSearch(context, options).run();
}

}  // namespace tribench::parfam
