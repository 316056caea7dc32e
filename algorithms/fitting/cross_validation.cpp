// SPDX-License-Identifier: MIT
#include "algorithms/fitting/cross_validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/fit_intervals.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/shape_dimension.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// How much larger a held-out error may be and count as no larger. The second was settled on seeds
// 101 to 110 of the generated adaptations: of 1, 2 and 3 the least error for two methods of three.
constexpr double kStandardErrors = 1;
constexpr double kStandardErrorsBeyond = 2;

// But nowhere may it be as many times the other's: a mean over few folds, one of which goes astray,
// has a standard error that forgives anything.
constexpr double kFarWorse = 2;

// Of the error held out (squared), what a longer formula has to be worth.
constexpr double kWorthIt = 0.1;

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

}  // namespace

std::vector<int> held_out_folds(std::span<const int> movement, std::size_t rows, int folds) {
  if (!movement.empty()) return folds_of(movement, folds);
  std::vector<int> own(rows);
  std::iota(own.begin(), own.end(), 0);
  return folds_of(own, folds);
}

namespace {

// Per row: is it held out?
using Marks = std::vector<char>;

std::vector<Marks> movement_holdouts(std::span<const int> movement, int folds) {
  const std::vector<int> fold = folds_of(movement, folds);
  const int used = fold.empty() ? 0 : 1 + *std::ranges::max_element(fold);
  std::vector<Marks> result;
  for (int f = 0; f < used; ++f) {
    Marks marks(fold.size());
    for (std::size_t r = 0; r < fold.size(); ++r) marks[r] = fold[r] == f ? 1 : 0;
    result.push_back(std::move(marks));
  }
  return result;
}

struct Side {
  std::size_t input = 0;
  bool upper = false;
};

// The sides on which the box is wider than the rows.
std::vector<Side> sides_beyond(const Inputs& inputs, const InputBox& box) {
  constexpr double kSlack = 0.05;  // of the rows' range
  std::vector<Side> sides;
  for (std::size_t j = 0; j < box.size() && inputs.rows > 0; ++j) {
    if (box[j].sign_of) continue;
    const auto [low, high] =
        std::minmax_element(inputs.columns[j], inputs.columns[j] + inputs.rows);
    const double slack = kSlack * (*high - *low);
    if (!(slack > 0)) continue;
    if (box[j].low < *low - slack) sides.push_back({j, false});
    if (box[j].high > *high + slack) sides.push_back({j, true});
  }
  return sides;
}

constexpr std::size_t kFewestBeyond = 10;  // held out, or left
constexpr std::size_t kFewFitted = 20;     // fitted, where single ones tell a formula's numbers

// The fifth of the rows that lies farthest on each such side.
std::vector<Marks> edge_holdouts(const Inputs& inputs, const InputBox& box) {
  constexpr std::size_t kPart = 5;
  std::vector<Marks> result;
  if (inputs.rows < kPart * kFewestBeyond) return result;
  for (const Side& side : sides_beyond(inputs, box)) {
    const double* column = inputs.columns[side.input];
    std::vector<double> sorted(column, column + inputs.rows);
    std::ranges::sort(sorted);
    const std::size_t place = inputs.rows / kPart;
    const double limit = side.upper ? sorted[inputs.rows - 1 - place] : sorted[place];
    Marks marks(inputs.rows);
    for (std::size_t r = 0; r < inputs.rows; ++r) {
      marks[r] = (side.upper ? column[r] > limit : column[r] < limit) ? 1 : 0;
    }
    if (std::ranges::count(marks, 1) >= static_cast<std::ptrdiff_t>(kFewestBeyond)) {
      result.push_back(std::move(marks));
    }
  }
  return result;
}

// The rows that lie farther out than the inner part which the whole range continues as far as the
// box continues the range: what is said beyond the rows is tried over the same stretch, on all
// such sides at once.
std::vector<Marks> outer_holdout(const Inputs& inputs, const InputBox& box) {
  Marks marks(inputs.rows);
  for (const Side& side : sides_beyond(inputs, box)) {
    const double* column = inputs.columns[side.input];
    const auto [low, high] = std::minmax_element(column, column + inputs.rows);
    const double middle = 0.5 * (*low + *high);
    const double half = 0.5 * (*high - *low);
    const double beyond = side.upper ? box[side.input].high - middle : middle - box[side.input].low;
    const double inner = half * half / beyond;
    for (std::size_t r = 0; r < inputs.rows; ++r) {
      const double out = side.upper ? column[r] - middle : middle - column[r];
      if (out > inner) marks[r] = 1;
    }
  }
  const auto held_out = static_cast<std::size_t>(std::ranges::count(marks, 1));
  if (held_out < kFewestBeyond || inputs.rows < held_out + kFewestBeyond) return {};
  return {marks};
}

struct Rows {
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  std::vector<double> target;

  Inputs inputs() const { return {pointers, target.size()}; }
};

Rows select_rows(const Inputs& inputs, std::span<const double> target, const Marks& marks,
                 char wanted) {
  Rows rows;
  rows.columns.resize(inputs.columns.size());
  for (std::size_t r = 0; r < target.size(); ++r) {
    if (marks[r] != wanted) continue;
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

// Formulas whose mean square is below this are all exact: a ten thousand millionth of the target's
// size, squared.
double rounding_of(std::span<const double> target) {
  double sum = 0;
  for (const double y : target) sum += y * y;
  return 1e-20 * sum / static_cast<double>(target.size());
}

// The held-out mean square of a formula whose constants are fitted anew. Fits start at what all
// rows said: a formula with as many numbers as there are rows to fit would keep to that, and what
// it knows of the rows held out would be no test. Nor would it be where a few rows leave a number
// open that one held out had told: no error is believed below what the fit says of its own there.
class Refit {
 public:
  explicit Refit(double rounding) : rounding_(rounding) {}

  double error(Expression formula, const Rows& train, const Rows& held_out) {
    if (shape_dimension(formula) + free_exponents(formula) >= train.target.size()) {
      return std::numeric_limits<double>::infinity();
    }
    node_rows_ += fitter_.fit(formula, train.inputs(), train.target).node_rows;
    const double error = std::max(rounding_, mean_square(evaluator_, formula, held_out));
    if (train.target.size() > kFewFitted) return error;
    return std::max(error,
                    mean_curve_variance(formula, train.inputs(), train.target, held_out.inputs()));
  }
  std::uint64_t node_rows() const { return node_rows_; }

 private:
  double rounding_;
  ConstantFitter fitter_;
  Evaluator evaluator_;
  std::uint64_t node_rows_ = 0;
};

// errors[k][f]: of formula k.
std::size_t simplest_good(const std::vector<std::vector<double>>& errors,
                          std::span<const double> means, double tolerance) {
  const auto best = static_cast<std::size_t>(std::ranges::min_element(means) - means.begin());
  for (std::size_t k = 0; k < best; ++k) {
    if (std::isfinite(means[k]) && as_good(errors[k], errors[best], tolerance)) return k;
  }
  return best;
}

// Points of the box, signs in agreement with what they are the signs of.
Rows points_of(const InputBox& box) {
  constexpr std::size_t kPoints = 2000;
  Rows points;
  points.columns.assign(box.size(), std::vector<double>(kPoints));
  points.target.assign(kPoints, 0);
  RandomStream random(key_of("points of the box"));
  for (std::size_t r = 0; r < kPoints; ++r) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      const double part = random.uniform(-0.25, 1.25);  // half of the points on the box's faces
      points.columns[j][r] = box[j].low + (box[j].high - box[j].low) * std::clamp(part, 0.0, 1.0);
    }
    for (std::size_t j = 0; j < box.size(); ++j) {
      if (box[j].sign_of) points.columns[j][r] = points.columns[*box[j].sign_of][r] < 0 ? -1 : 1;
    }
  }
  for (const auto& column : points.columns) points.pointers.push_back(column.data());
  return points;
}

// What a straight line through the rows' range can come to over the box: the range of the target,
// as many times as the box is wider than the rows.
class Band {
 public:
  Band(const Inputs& inputs, std::span<const double> target, const InputBox& box)
      : points_(points_of(box)), values_(points_.target.size()) {
    double wider = 1;
    for (const Side& side : sides_beyond(inputs, box)) {
      const double* column = inputs.columns[side.input];
      const auto [low, high] = std::minmax_element(column, column + inputs.rows);
      wider = std::max(
          wider, (std::max(box[side.input].high, *high) - std::min(box[side.input].low, *low)) /
                     (*high - *low));
    }
    const auto [low, high] = std::ranges::minmax(target);
    middle_ = 0.5 * (low + high);
    reach_ = wider * (high - low);
  }

  bool holds(Evaluator& evaluator, const Expression& formula) {
    evaluator.evaluate(formula, points_.inputs(), values_);
    return std::ranges::all_of(values_,
                               [&](double value) { return std::abs(value - middle_) <= reach_; });
  }

 private:
  Rows points_;
  std::vector<double> values_;
  double middle_ = 0;
  double reach_ = 0;
};

}  // namespace

bool as_good(std::span<const double> errors, std::span<const double> best, double tolerance) {
  const auto folds = static_cast<double>(best.size());
  double mean = 0;
  for (std::size_t f = 0; f < best.size(); ++f) {
    if (!(errors[f] <= kFarWorse * best[f])) return false;
    mean += (errors[f] - best[f]) / folds;
  }
  double variance = 0;
  for (std::size_t f = 0; f < best.size(); ++f) {
    const double difference = errors[f] - best[f] - mean;
    variance += difference * difference;
  }
  return mean < tolerance * std::sqrt(variance / (folds * (folds - 1)));
}

bool reaches_beyond(const Inputs& inputs, const InputBox& box) {
  return !sides_beyond(inputs, box).empty();
}

CrossValidation cross_validate(std::span<const Expression> formulas, const Inputs& inputs,
                               std::span<const double> target, std::span<const int> movement,
                               const InputBox& box, int folds, const std::function<bool()>& in_time,
                               Beyond held_out_beyond) {
  CrossValidation result;
  result.chosen = formulas.size() - 1;
  std::vector<Marks> holdouts = movement_holdouts(movement, folds);
  if (holdouts.size() < 2) return result;
  std::ranges::move(
      held_out_beyond == Beyond::edges ? edge_holdouts(inputs, box) : outer_holdout(inputs, box),
      std::back_inserter(holdouts));
  Refit refit(rounding_of(target));
  std::vector<std::vector<double>>& errors = result.fold_errors;
  errors.resize(formulas.size());
  for (const Marks& marks : holdouts) {
    const Rows train = select_rows(inputs, target, marks, 0);
    const Rows held_out = select_rows(inputs, target, marks, 1);
    for (std::size_t k = 0; k < formulas.size(); ++k) {
      if (in_time && !in_time()) return result;
      errors[k].push_back(refit.error(formulas[k], train, held_out));
      result.node_rows = refit.node_rows();
    }
  }
  for (const std::vector<double>& of_formula : errors) {
    double mean = 0;
    for (const double e : of_formula) mean += e / static_cast<double>(holdouts.size());
    result.mean_square.push_back(mean);
  }
  const bool beyond = reaches_beyond(inputs, box);
  if (beyond) {
    Band band(inputs, target, box);
    Evaluator evaluator;
    for (std::size_t k = 0; k < formulas.size(); ++k) {
      if (!band.holds(evaluator, formulas[k])) {
        result.mean_square[k] = std::numeric_limits<double>::infinity();
      }
    }
  }
  result.chosen =
      simplest_good(errors, result.mean_square, beyond ? kStandardErrorsBeyond : kStandardErrors);
  return result;
}

std::size_t simplest_as_good(std::span<const double> mean_square) {
  const double enough = (1 + kWorthIt) * std::ranges::min(mean_square);
  const auto first =
      std::ranges::find_if(mean_square, [enough](double square) { return square <= enough; });
  return first == mean_square.end() ? 0 : static_cast<std::size_t>(first - mean_square.begin());
}

}  // namespace tribench
