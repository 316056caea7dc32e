// SPDX-License-Identifier: MIT
#include "algorithms/model_based/branch_polynomial.hpp"

#include <fmt/format.h>

#include "algorithms/expression/build.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/missing_role.hpp"
#include "algorithms/model_based/friction_inputs.hpp"

namespace tribench {
namespace {

using namespace build;

constexpr int kDegree = 3;

// Columns v^k and s v^k for k = 0 .. 3, then the acceleration.
std::vector<std::vector<double>> make_columns(const FiniteRows& data,
                                              const FrictionInputs& inputs) {
  const std::vector<double>& v = data.columns[inputs.velocity];
  std::vector<double> sign(data.rows());
  Evaluator().evaluate(inputs.sign(), data.table(), sign);
  std::vector<std::vector<double>> columns = {std::vector<double>(data.rows(), 1.0), sign};
  for (int k = 1; k <= kDegree; ++k) {
    for (int which = 0; which < 2; ++which) {
      std::vector<double> column = columns[columns.size() - 2];
      for (std::size_t row = 0; row < column.size(); ++row) column[row] *= v[row];
      columns.push_back(std::move(column));
    }
  }
  if (inputs.acceleration) columns.push_back(data.columns[*inputs.acceleration]);
  return columns;
}

// c0 + c1 s, as much of it as is there.
Expression coefficient(double c0, double c1, const Expression& sign) {
  const Expression odd = c1 == 0 ? Expression() : constant(c1) * sign;
  return c0 == 0 && !odd.empty() ? odd : sum_of(constant(c0), odd);
}

// Horner's scheme.
Expression formula_of(std::span<const double> c, const FrictionInputs& inputs) {
  const Expression sign = inputs.sign();
  constexpr std::size_t kLast = 2 * std::size_t{kDegree};
  Expression result = coefficient(c[kLast], c[kLast + 1], sign);
  for (std::size_t k = kDegree; k-- > 0;) {
    result = coefficient(c[2 * k], c[2 * k + 1], sign) + input(inputs.velocity) * result;
  }
  if (inputs.acceleration) result = result + constant(c.back()) * input(*inputs.acceleration);
  return result;
}

class BranchPolynomial : public Regressor {
 public:
  FitResult fit(FitContext& context) const override {
    const auto inputs = find_friction_inputs(context.data.inputs);
    if (!inputs) {
      return unsupported_without_role("the branch polynomial needs an input", "velocity");
    }
    const FiniteRows data(context.data);
    if (data.rows() == 0) return FitResult::unsupported("there is no row without missing values");
    const auto columns = make_columns(data, *inputs);
    const std::size_t needed = columns.size() * columns.size() * data.rows();
    if (!context.budget.spend(needed)) {
      return {{}, 0, StopReason::budget, shortage(context.budget, needed)};
    }
    std::vector<const double*> pointers;
    for (const auto& column : columns) pointers.push_back(column.data());
    const LinearFit fit = solve_least_squares(pointers, data.target);
    FitResult result;
    result.front = {formula_of(fit.coefficients, *inputs)};
    result.note = fmt::format("rank {} of {}, condition number {:.1e}", fit.rank, columns.size(),
                              fit.condition);
    if (context.progress != nullptr) {
      context.progress->improved(fit.sum_squares / static_cast<double>(data.rows()),
                                 context.budget.spent());
    }
    return result;
  }
};

}  // namespace

AlgorithmEntry branch_polynomial_entry() {
  return {"branch_polynomial",
          "a cubic in velocity for each direction, exact least squares",
          {},
          true,
          [](const Parameters&, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<BranchPolynomial>();
          }};
}

}  // namespace tribench
