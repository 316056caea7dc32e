// SPDX-License-Identifier: MIT
#include "algorithms/fitting/evidence_pruning.hpp"
#include "algorithms/fitting/free_constants.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/simplify.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/fitting/formula_jacobian.hpp"
#include "algorithms/fitting/spread_rows.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kFarOff = 0.3;  // of an exponent from the value it may be
constexpr int kIterations = 8;   // of the others' fit
constexpr std::size_t kMostConstants = 14;
constexpr double kNodesSaved = 2;  // that a 0 or a 1 takes with it: itself and its operation
constexpr std::size_t kForecastRows = 5000;
constexpr double kLoaded = 1e-10;  // of J^T J's scaled diagonal: constants may stand for each other

// A value for the constant at a place of the tape.
struct ValueOf {
  std::size_t place = 0;
  double value = 0;
  double saved = 0;     // nats, by the number that is no longer free and what goes with it
  double forecast = 0;  // nats: that less what the rows are expected to mind
};

class Pruning {
 public:
  Pruning(Expression formula, const Inputs& inputs, std::span<const double> target,
          const std::function<bool(std::uint64_t)>& spend)
      : formula_(std::move(formula)), inputs_(inputs), target_(target), spend_(spend) {
    for (const std::size_t p : constant_positions(formula_)) {
      if (is_settled(formula_, p)) held_.insert(p);
    }
  }

  // False where nothing was to be done.
  bool run() {
    const std::size_t constants = constant_positions(formula_).size();
    if (constants == held_.size() || constants > kMostConstants) return false;
    square_ = refitted(formula_, held_);
    if (!(square_ > 0) || !std::isfinite(square_)) return false;
    bool any = false;
    while (!is_spent_ && step()) any = true;
    return any;
  }

  const Expression& formula() const { return formula_; }

 private:
  static bool is_settled(const Expression& formula, std::size_t place) {
    return is_exponent(formula, place) && is_simple_exponent(formula.node(place).value);
  }

  std::vector<double> values_for(std::size_t place) const {
    const double c = formula_.node(place).value;
    // A sum's 1 is a number as any other.
    if (!is_exponent(formula_, place)) {
      return is_factor(place) ? std::vector<double>{0, 1, -1} : std::vector<double>{0};
    }
    std::vector<double> values;
    for (const int q : {1, 2, 3}) {
      const double value = std::nearbyint(c * q) / q;
      if (std::abs(value - c) <= kFarOff && std::ranges::count(values, value) == 0) {
        values.push_back(value);
      }
    }
    return values;
  }

  bool is_factor(std::size_t place) const {
    for (std::size_t i = place + 1; i < formula_.size(); ++i) {
      const Op op = formula_.node(i).op;
      const int children = arity(op);
      const bool is_above = (children >= 1 && formula_.last_child(i) == place) ||
                            (children == 2 && formula_.left_child(i) == place);
      if (is_above) return op == Op::mul || op == Op::div;
    }
    return false;
  }

  // What a value is less likely than a whole number, in nats.
  static double oddity(double exponent) {
    if (exponent == std::nearbyint(exponent)) return 0;
    return 2 * exponent == std::nearbyint(2 * exponent) ? 1 : 2;
  }

  // The mean square; the constants of `candidate` that are not held are moved.
  double refitted(Expression& candidate, const std::set<std::size_t>& held) {
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    std::vector<double> low;
    std::vector<double> high;
    for (const std::size_t p : constant_positions(candidate)) {
      const double c = candidate.node(p).value;
      low.push_back(held.contains(p) ? c : -kUnbounded);
      high.push_back(held.contains(p) ? c : kUnbounded);
    }
    ConstantFitOptions options;
    options.max_iterations = kIterations;
    options.exponents = FitExponents::all;
    options.low = low;
    options.high = high;
    const ConstantFitResult fit = fitter_.fit(candidate, inputs_, target_, {}, options);
    is_spent_ = !spend_(fit.node_rows);
    return fit.sum_squares / static_cast<double>(target_.size());
  }

  // The likeliest first, by what the rows mind where the formula is linear in its constants and
  // the others move along: (c - value)^2 over what J^T J's inverse has there.
  std::vector<ValueOf> values_by_forecast() const {
    std::vector<std::size_t> places;
    for (const std::size_t p : constant_positions(formula_)) {
      if (!held_.contains(p)) places.push_back(p);
    }
    if (places.empty()) return {};
    const double number = 0.5 * elementary::log(static_cast<double>(target_.size()));
    const Eigen::VectorXd minded = minded_by_rows(places);
    std::vector<ValueOf> all;
    for (std::size_t k = 0; k < places.size(); ++k) {
      for (const double value : values_for(places[k])) {
        const double saved =
            number + (is_exponent(formula_, places[k]) ? -oddity(value) : kNodesSaved * kNodePrice);
        const double off = value - formula_.node(places[k]).value;
        all.push_back({places[k], value, saved,
                       saved - nats_of(1 + off * off * minded[static_cast<Eigen::Index>(k)])});
      }
    }
    std::ranges::stable_sort(all, std::greater{}, &ValueOf::forecast);
    return all;
  }

  // Of each constant: what a unit of it adds to the mean square, over the mean square, the others
  // moved along. 0 where that is not known.
  Eigen::VectorXd minded_by_rows(const std::vector<std::size_t>& places) const {
    const auto count = static_cast<Eigen::Index>(places.size());
    const SpreadRows some(inputs_, kForecastRows);
    std::vector<double> values(some.table().rows);
    Eigen::MatrixXd jacobian = jacobian_of(formula_, places, some.table(), values);
    const Eigen::VectorXd length = jacobian.colwise().stableNorm();
    if (!jacobian.allFinite() || !(length.minCoeff() > 0)) return Eigen::VectorXd::Zero(count);
    jacobian *= length.cwiseInverse().asDiagonal();
    Eigen::MatrixXd product = jacobian.transpose() * jacobian;
    product.diagonal().array() += kLoaded;
    const Eigen::VectorXd free = inverse_symmetric(product).diagonal();
    const double squares = square_ * static_cast<double>(values.size());
    return length.cwiseAbs2().cwiseQuotient(free) / squares;
  }

  double nats_of(double ratio_of_squares) const {
    return 0.5 * static_cast<double>(target_.size()) *
           elementary::log(std::max(ratio_of_squares, 1e-300));
  }

  // The value that is worth most, as far as forecasts go; all are tried where none is worth it.
  bool step() {
    double most = 0;
    Expression best;
    std::size_t best_place = 0;
    double best_square = 0;
    for (const ValueOf& one : values_by_forecast()) {
      if (is_spent_ || (most > 0 && most >= one.forecast)) break;
      Expression candidate = formula_;
      set_constant(candidate, one.place, one.value);
      std::set<std::size_t> held = held_;
      held.insert(one.place);
      const double square = refitted(candidate, held);
      if (!std::isfinite(square)) continue;
      const double gain = one.saved - nats_of(square / square_);
      if (!(gain > most)) continue;
      most = gain;
      best = std::move(candidate);
      best_place = one.place;
      best_square = square;
    }
    if (best.empty()) return false;
    formula_ = std::move(best);
    square_ = best_square;
    held_.insert(best_place);
    return true;
  }

  Expression formula_;
  const Inputs& inputs_;
  std::span<const double> target_;
  const std::function<bool(std::uint64_t)>& spend_;
  bool is_spent_ = false;
  ConstantFitter fitter_;
  std::set<std::size_t> held_;  // places of the tape
  double square_ = 0;
};

}  // namespace

Expression pruned_by_evidence(const Expression& formula, const Inputs& inputs,
                              std::span<const double> target, const InputBox& box,
                              const std::function<bool(std::uint64_t)>& spend) {
  Pruning pruning(formula, inputs, target, spend);
  if (!pruning.run()) return formula;
  return simplify(pruning.formula(), box);
}

}  // namespace tribench
