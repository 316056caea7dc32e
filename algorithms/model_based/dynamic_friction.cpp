// SPDX-License-Identifier: MIT
#include "algorithms/model_based/dynamic_friction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "algorithms/missing_role.hpp"
#include "algorithms/model_based/dynamic_models.hpp"

namespace tribench {
namespace {

constexpr double kStartShows = 0.05;

bool is_finite_along(const MotionRows& motion, std::size_t column) {
  return std::all_of(motion.columns[column], motion.columns[column] + motion.rows(),
                     [](double x) { return std::isfinite(x); });
}

std::vector<std::size_t> finite_rows(const TrainingData& data) {
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < data.rows(); ++r) {
    bool finite = std::isfinite(data.target[r]);
    for (const double* column : data.columns) finite = finite && std::isfinite(column[r]);
    if (finite) rows.push_back(r);
  }
  return rows;
}

std::vector<double> target_at(const TrainingData& data, const std::vector<std::size_t>& rows) {
  std::vector<double> target;
  for (const std::size_t row : rows) target.push_back(data.target[row]);
  return target;
}

class DynamicFriction : public Regressor {
 public:
  DynamicFriction(DynamicModel model, const Parameters& parameters)
      : model_(model),
        terms_{parameters.flag("asymmetric"), parameters.flag("offset"), parameters.flag("load")} {}

  FitResult fit(FitContext& context) const override;

 private:
  DynamicFeatures features(FitContext& context, const FrictionInputs& inputs,
                           std::vector<std::size_t> rows) const {
    return {model_, terms_, inputs, context.data, std::move(rows), context.budget};
  }

  DynamicModel model_;
  DynamicTerms terms_;
};

// What a user asks of such a fit: how stiff the bristles are and how far they bend.
std::string note_of(const SeparableFit& fit, const std::vector<StateDeclaration>& states) {
  std::string note = fmt::format("stiffness {:.4g}", fit.coefficients[0]);
  if (states.size() == 1) {
    note += fmt::format(", sliding deflection {:.3g}", states[0].parameters[0]);
  }
  return note;
}

FitResult DynamicFriction::fit(FitContext& context) const {
  const TrainingData& data = context.data;
  const auto inputs = find_friction_inputs(data.inputs);
  if (!inputs) {
    return unsupported_without_role("friction with memory needs an input", "velocity");
  }
  if (!data.has_time()) {
    return unsupported_without_role("friction with memory needs rows in time: a column", "time");
  }
  if (!is_finite_along(data.motion, inputs->velocity)) {
    return FitResult::unsupported("the velocity has missing values along the recording");
  }
  std::vector<std::size_t> rows = finite_rows(data);
  if (context.budget.remaining() == 0) return {{}, 0, StopReason::budget, "no budget"};
  DynamicFeatures whole = features(context, *inputs, rows);
  if (rows.size() < 2 * (whole.features() + whole.parameters())) {
    return FitResult::unsupported(
        fmt::format("{} rows are too few for {} coefficients and {} parameters", rows.size(),
                    whole.features(), whole.parameters()));
  }
  SeparableOptions options = whole.options();
  SeparableFit fit = fit_separable(whole, target_at(data, rows), options);
  if (!std::isfinite(fit.sum_squares)) return {{}, 0, StopReason::budget, "no budget for a fit"};
  // Once more without the rows whose state is still that of an unknown start.
  const std::vector<double> influence = whole.start_influence(fit.theta);
  std::vector<std::size_t> settled;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (influence[r] <= kStartShows) settled.push_back(rows[r]);
  }
  if (settled.size() < rows.size() && 2 * settled.size() >= rows.size()) {
    DynamicFeatures later = features(context, *inputs, settled);
    options.starts = {fit.theta};
    SeparableFit again = fit_separable(later, target_at(data, settled), options);
    if (std::isfinite(again.sum_squares)) fit = std::move(again);
  }
  FitResult result;
  result.reason = context.budget.exhausted() ? StopReason::budget : StopReason::converged;
  result.states = whole.states(fit.theta);
  result.front = {whole.formula(fit.theta, fit.coefficients)};
  result.keeps_form = true;
  result.note = note_of(fit, result.states);
  if (context.progress != nullptr) {
    context.progress->improved(fit.sum_squares / static_cast<double>(rows.size()),
                               context.budget.spent());
  }
  return result;
}

std::vector<ParameterSpec> specs() {
  return {{"asymmetric", "each direction its own force", false},
          {"offset", "adds a constant sensor offset", true},
          {"load", "bristles press harder under load (role gravity_torque)", false}};
}

template <DynamicModel model>
std::unique_ptr<Regressor> make(const Parameters& parameters, const MakeMethod&) {
  return std::make_unique<DynamicFriction>(model, parameters);
}

}  // namespace

AlgorithmEntry dahl_entry() {
  return {"dahl", "friction with memory: bristles of one stiffness (needs time)", specs(), true,
          make<DynamicModel::dahl>};
}

AlgorithmEntry lugre_entry() {
  return {"lugre", "friction with memory: bristles on a Stribeck curve (needs time)", specs(), true,
          make<DynamicModel::lugre>};
}

AlgorithmEntry maxwell_slip_entry() {
  return {"maxwell_slip", "friction with memory: generalised Maxwell slip, 4 elements (needs time)",
          specs(), true, make<DynamicModel::maxwell_slip>};
}

}  // namespace tribench
