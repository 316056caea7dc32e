// SPDX-License-Identifier: MIT
#include "algorithms/model_based/static_friction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/differentiate.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/missing_role.hpp"
#include "algorithms/model_based/bounded_stribeck.hpp"
#include "algorithms/model_based/coulomb_viscous.hpp"
#include "algorithms/model_based/printed_stribeck.hpp"

namespace tribench {
namespace {

constexpr double kUnidentified = 1e6;  // condition number from which parameters mean nothing

double sign_of(double x) { return static_cast<double>(x > 0) - static_cast<double>(x < 0); }

StribeckRows make_rows(const FiniteRows& data, const FrictionInputs& inputs, bool asymmetric) {
  StribeckRows rows;
  rows.velocity = data.columns[inputs.velocity];
  rows.target = data.target;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    const double sign = inputs.velocity_sign ? data.columns[*inputs.velocity_sign][row]
                                             : sign_of(rows.velocity[row]);
    rows.sign.push_back(sign);
    rows.branch.push_back(asymmetric && sign < 0 ? 1 : 0);
  }
  if (inputs.acceleration) rows.acceleration = data.columns[*inputs.acceleration];
  return rows;
}

// How well the data determine the constants of the formula, as one number.
double condition_of(const Expression& formula, const FiniteRows& data) {
  std::vector<std::size_t> places;
  for (std::size_t place : constant_positions(formula)) {
    // 0.5 s + 0.5 of the asymmetric form is no parameter.
    if (formula.node(place).value != 0.5) places.push_back(place);
  }
  Differentiator differentiator;
  differentiator.prepare(formula, places);
  std::vector<double> jacobian(places.size() * data.rows());
  differentiator.jacobian(data.table(), {}, jacobian);
  std::vector<const double*> columns;
  for (std::size_t k = 0; k < places.size(); ++k) {
    columns.push_back(jacobian.data() + k * data.rows());
  }
  if (!std::ranges::all_of(jacobian, [](double x) { return std::isfinite(x); })) {
    return std::numeric_limits<double>::infinity();
  }
  return solve_least_squares(columns, data.target).condition;
}

class StaticFriction : public Regressor {
 public:
  StaticFriction(const Parameters& parameters, bool asymmetric)
      : asymmetric_(asymmetric),
        form_(parameters.text("form")),
        offset_(parameters.flag("offset")) {}

  FitResult fit(FitContext& context) const override;

 private:
  StribeckFit fit_form(const StribeckRows& rows, StribeckModel& model, FitContext& context) const;

  bool asymmetric_;
  std::string form_;
  bool offset_;
};

StribeckFit StaticFriction::fit_form(const StribeckRows& rows, StribeckModel& model,
                                     FitContext& context) const {
  if (form_ == "as_printed") {
    return fit_printed_stribeck(rows, model, context.budget, context.random);
  }
  if (form_ == "coulomb_viscous") return fit_coulomb_viscous(rows, model, context.budget);
  return fit_bounded_stribeck(rows, model, context.budget);
}

FitResult StaticFriction::fit(FitContext& context) const {
  const auto inputs = find_friction_inputs(context.data.inputs);
  if (!inputs) {
    return unsupported_without_role("the static friction model needs an input", "velocity");
  }
  const FiniteRows data(context.data);
  if (data.rows() == 0) return FitResult::unsupported("there is no row without missing values");
  const StribeckRows rows = make_rows(data, *inputs, asymmetric_);
  StribeckModel model;
  model.branches.resize(asymmetric_ ? 2 : 1);
  model.has_offset = offset_;
  model.has_inertia = inputs->acceleration.has_value();
  if (context.budget.remaining() == 0) return {{}, 0, StopReason::budget, "no budget"};
  const StribeckFit fit = fit_form(rows, model, context);
  FitResult result;
  result.reason = fit.out_of_budget ? StopReason::budget : StopReason::converged;
  result.front = {model.formula(*inputs)};
  result.ranges = model.formula_ranges(form_ == "bounded" ? physical_ranges(rows) : BranchRanges{});
  if (context.progress != nullptr) {
    context.progress->improved(fit.sum_squares / static_cast<double>(rows.size()),
                               context.budget.spent());
  }
  const double condition = condition_of(result.front[0], data);
  result.note = condition > kUnidentified
                    ? fmt::format("parameters not identified: condition number {:.1e}", condition)
                    : fmt::format("condition number {:.1e}", condition);
  return result;
}

std::vector<ParameterSpec> specs() {
  return {{"form",
           "bounded: Fs >= Fc >= 0, 0 < vs <= max|v|, 0.5 <= delta <= 4, global optimum; "
           "as_printed: SciPy's basin hopping without bounds, as the paper's; "
           "coulomb_viscous: no Stribeck term, exact least squares",
           std::string("bounded"),
           -1e308,
           1e308,
           {"bounded", "as_printed", "coulomb_viscous"}},
          {"offset", "adds a constant sensor offset", false}};
}

}  // namespace

AlgorithmEntry symmetric_entry() {
  return {"symmetric", "static friction model (Stribeck), the same in both directions", specs(),
          true, [](const Parameters& parameters, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<StaticFriction>(parameters, false);
          }};
}

AlgorithmEntry asymmetric_entry() {
  return {"asymmetric", "static friction model (Stribeck), each direction with its own parameters",
          specs(), true,
          [](const Parameters& parameters, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<StaticFriction>(parameters, true);
          }};
}

}  // namespace tribench
