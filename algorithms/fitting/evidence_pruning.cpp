// SPDX-License-Identifier: MIT
#include "algorithms/fitting/evidence_pruning.hpp"
#include "algorithms/fitting/free_constants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/simplify.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kFarOff = 0.3;  // of an exponent from the value it may be
constexpr int kIterations = 8;   // of the others' fit
constexpr std::size_t kMostConstants = 14;
constexpr double kNodesSaved = 2;  // that a 0 or a 1 takes with it: itself and its operation

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
    while (step()) any = true;
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

  // The one value that is worth most.
  bool step() {
    const auto n = static_cast<double>(target_.size());
    const double number = 0.5 * elementary::log(n);
    double most = 0;
    Expression best;
    std::size_t best_place = 0;
    double best_square = 0;
    for (const std::size_t p : constant_positions(formula_)) {
      if (held_.contains(p)) continue;
      for (const double value : values_for(p)) {
        if (is_spent_) return false;
        Expression candidate = formula_;
        set_constant(candidate, p, value);
        std::set<std::size_t> held = held_;
        held.insert(p);
        const double square = refitted(candidate, held);
        if (!std::isfinite(square)) continue;
        const bool is_exponent_here = is_exponent(formula_, p);
        const double saved =
            number + (is_exponent_here ? -oddity(value) : kNodesSaved * kNodePrice);
        const double gain = saved - 0.5 * n * elementary::log(std::max(square, 1e-300) / square_);
        if (!(gain > most)) continue;
        most = gain;
        best = std::move(candidate);
        best_place = p;
        best_square = square;
      }
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
