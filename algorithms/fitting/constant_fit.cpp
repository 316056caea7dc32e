// SPDX-License-Identifier: MIT
#include "algorithms/fitting/constant_fit.hpp"

#include <vector>

#include "algorithms/expression/differentiate.hpp"

namespace tribench {
namespace {

// A backward pass with its sums costs about two forward passes (bench/fitting_bench).
constexpr std::uint64_t kJacobianCost = 2;

}  // namespace

struct ConstantFitter::Workspace : public LeastSquaresProblem {
  // The problem, as long as a fit runs.
  const Inputs* inputs = nullptr;
  std::span<const double> target;
  std::span<const double> weights;
  std::uint64_t pass_cost = 0;
  std::uint64_t spent = 0;

  Differentiator differentiator;
  LevenbergMarquardt minimizer;
  std::vector<std::size_t> places;
  std::vector<double> constants;

  void choose_constants(const Expression& formula, bool fit_exponents);

  double sum_squares(std::span<const double> x) override {
    spent += pass_cost;
    differentiator.set_constants(x);
    return differentiator.sum_squares(*inputs, target, weights);
  }
  void normal_equations(NormalEquations& sums) override {
    spent += kJacobianCost * pass_cost;
    differentiator.normal_equations(*inputs, target, weights, sums);
  }
};

void ConstantFitter::Workspace::choose_constants(const Expression& formula, bool fit_exponents) {
  places.clear();
  constants.clear();
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!formula.node(i).is_constant()) continue;
    // An exponent is a right child, so its parent is the next place of the tape.
    const bool exponent = i + 1 < formula.size() && formula.node(i + 1).op == Op::pow;
    if (exponent && !fit_exponents) continue;
    places.push_back(i);
    constants.push_back(formula.node(i).value);
  }
}

ConstantFitter::ConstantFitter() : workspace_(std::make_unique<Workspace>()) {}
ConstantFitter::~ConstantFitter() = default;
ConstantFitter::ConstantFitter(ConstantFitter&&) noexcept = default;
ConstantFitter& ConstantFitter::operator=(ConstantFitter&&) noexcept = default;

ConstantFitResult ConstantFitter::fit(Expression& formula, const Inputs& inputs,
                                      std::span<const double> target,
                                      std::span<const double> weights,
                                      const ConstantFitOptions& options) {
  Workspace& work = *workspace_;
  work.inputs = &inputs;
  work.target = target;
  work.weights = weights;
  work.pass_cost = node_rows(formula, inputs.rows);
  work.spent = 0;
  work.choose_constants(formula, options.fit_exponents);
  work.differentiator.prepare(formula, work.places);
  const LevenbergMarquardtResult fit = work.minimizer.minimize(
      work, work.constants,
      {options.max_iterations, options.gradient_tolerance, options.step_tolerance,
       options.function_tolerance, options.low, options.high});
  for (std::size_t k = 0; k < work.places.size(); ++k) {
    formula.set_constant(work.places[k], work.constants[k]);
  }
  return {fit.status, fit.sum_squares, fit.iterations, work.spent};
}

}  // namespace tribench
