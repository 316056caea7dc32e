// SPDX-License-Identifier: MIT
#include "algorithms/model_based/dynamic_models.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "algorithms/expression/build.hpp"
#include "algorithms/states/state_column.hpp"
#include "foundation/elementary.hpp"
#include "foundation/sign.hpp"

namespace tribench {
namespace {

constexpr std::uint64_t kStateNodes = 12;  // what a row of a state costs, in nodes of a formula
constexpr double kMostRatio = 8;           // of breakaway to sliding

// Places in theta. A length, a velocity and a time are logarithms, so that steps are relative.
constexpr std::size_t kSliding = 0;
constexpr std::size_t kRatio = 1;  // breakaway / sliding
constexpr std::size_t kStribeckSpeed = 2;
constexpr std::size_t kGrowth = 3;  // maxwell_slip: of the limits from element to element
constexpr std::size_t kAttraction = 4;

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

bool is_start(const MotionRows& motion, std::size_t row) {
  return std::ranges::binary_search(motion.starts, row);
}

std::vector<double> steps_of(double low, double high, std::size_t count) {
  std::vector<double> steps;
  for (std::size_t i = 0; i < count; ++i) {
    steps.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return steps;
}

// What a motion is like: the grid that states are looked for on.
struct MotionScales {
  double step_seconds = 0;
  double step_travel = 0;  // how far the joint comes in a step
  double span = 0;         // and between its extremes
  double top_speed = 0;
};

double step_seconds_of(const MotionRows& motion) {
  std::vector<double> steps;
  for (std::size_t r = 1; r < motion.rows(); ++r) {
    if (!is_start(motion, r)) steps.push_back(motion.time[r] - motion.time[r - 1]);
  }
  return median_of(std::move(steps));
}

double span_of(const MotionRows& motion, const double* v) {
  double widest = 0;
  double at = 0;
  double low = 0;
  double high = 0;
  for (std::size_t r = 1; r < motion.rows(); ++r) {
    if (is_start(motion, r)) {
      at = low = high = 0;
      continue;
    }
    at += 0.5 * (v[r - 1] + v[r]) * (motion.time[r] - motion.time[r - 1]);
    low = std::min(low, at);
    high = std::max(high, at);
    widest = std::max(widest, high - low);
  }
  return widest;
}

// velocity: the column of the motion; speeds at the used rows count.
MotionScales scales_of(const MotionRows& motion, std::size_t velocity,
                       std::vector<double> used_velocities) {
  for (double& v : used_velocities) v = std::abs(v);
  MotionScales scales;
  for (const double speed : used_velocities) scales.top_speed = std::max(scales.top_speed, speed);
  scales.step_seconds = step_seconds_of(motion);
  scales.step_travel = median_of(std::move(used_velocities)) * scales.step_seconds;
  scales.span = span_of(motion, motion.columns[velocity]);
  return scales;
}

// z' = v - |v| z / g(v), as the formula has it.
void write_rate(const StateDeclaration& state, std::span<const double> velocity,
                std::span<const double> z, std::span<double> out) {
  for (std::size_t r = 0; r < z.size(); ++r) {
    out[r] = state_rate(state.law, state.parameters, {z[r], false}, {velocity[r], 1});
  }
}

// Of z' by theta j, where z itself moves by `slope`.
void write_rate_slope(const StateDeclaration& state,
                      const std::vector<std::vector<double>>& by_theta, std::size_t j,
                      std::span<const double> velocity, std::span<const double> z,
                      std::span<const double> slope, std::span<double> out) {
  const std::vector<double>& p = state.parameters;
  for (std::size_t r = 0; r < z.size(); ++r) {
    const double speed = std::abs(velocity[r]);
    const double ratio = speed / p[2];
    const double share = elementary::exp(-(ratio * ratio));
    const double g = p[0] + (p[1] - p[0]) * share;
    const double moved = by_theta[0][j] * (1 - share) + by_theta[1][j] * share +
                         by_theta[2][j] * (p[1] - p[0]) * share * 2 * ratio * ratio / p[2];
    out[r] = -speed * (slope[r] - z[r] * moved / g) / g;
  }
}

}  // namespace

DynamicFeatures::DynamicFeatures(DynamicModel model, DynamicTerms terms,
                                 const FrictionInputs& inputs, const TrainingData& data,
                                 std::vector<std::size_t> rows, Budget& budget)
    : model_(model),
      terms_(terms),
      inputs_(inputs),
      data_(data),
      rows_(std::move(rows)),
      budget_(budget) {
  for (std::size_t j = 0; j < data.inputs.size() && !load_; ++j) {
    if (data.inputs[j].role == Role::gravity_torque) load_ = j;
  }
  if (!load_) terms_.load = false;
  for (const std::size_t row : rows_) {
    velocity_.push_back(data.columns[inputs.velocity][row]);
    if (terms_.load) load_size_.push_back(std::abs(data.columns[*load_][row]));
  }
  linear_ = linear_columns();
}

std::vector<std::vector<double>> DynamicFeatures::linear_columns() const {
  std::vector<std::vector<double>> columns = {velocity_};
  if (terms_.asymmetric) {
    columns.push_back(velocity_);
    for (double& v : columns.back()) v = std::abs(v);
  }
  for (const std::optional<std::size_t>& input : {inputs_.acceleration, load_}) {
    if (!input) continue;
    columns.emplace_back();
    for (const std::size_t row : rows_) columns.back().push_back(data_.columns[*input][row]);
  }
  if (terms_.offset) columns.emplace_back(rows_.size(), 1.0);
  return columns;
}

std::size_t DynamicFeatures::state_count() const {
  return model_ == DynamicModel::maxwell_slip ? kElements : 1;
}

std::size_t DynamicFeatures::own_features() const {
  const std::size_t each = 1U + (terms_.load ? 1U : 0U) + (terms_.asymmetric ? 1U : 0U);
  return each * state_count() + (model_ == DynamicModel::lugre ? 1U : 0U);
}

std::size_t DynamicFeatures::features() const { return own_features() + linear_.size(); }

std::size_t DynamicFeatures::parameters() const {
  constexpr std::array<std::size_t, 3> kCounts = {1, 3, 5};
  return kCounts[static_cast<std::size_t>(model_)];
}

std::vector<StateDeclaration> DynamicFeatures::states(std::span<const double> theta) const {
  const double sliding = elementary::exp(theta[kSliding]);
  if (model_ == DynamicModel::dahl) {
    return {{"z", StateLaw::dahl, {inputs_.velocity}, {sliding}}};
  }
  const double stribeck = elementary::exp(theta[kStribeckSpeed]);
  if (model_ == DynamicModel::lugre) {
    return {
        {"z", StateLaw::lugre, {inputs_.velocity}, {sliding, sliding * theta[kRatio], stribeck}}};
  }
  const double growth = elementary::exp(theta[kGrowth]);
  const double attraction = elementary::exp(theta[kAttraction]);
  std::vector<StateDeclaration> elements;
  double limit = sliding;
  for (std::size_t i = 0; i < kElements; ++i) {
    elements.push_back({"z" + std::to_string(i + 1),
                        StateLaw::gms,
                        {inputs_.velocity},
                        {limit, limit * theta[kRatio], stribeck, attraction}});
    limit *= growth;
  }
  return elements;
}

std::vector<std::vector<std::vector<double>>> DynamicFeatures::parameter_slopes(
    std::span<const double> theta) const {
  std::vector<std::vector<std::vector<double>>> slopes;
  const std::vector<StateDeclaration> all = states(theta);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<double>& p = all[i].parameters;
    std::vector<std::vector<double>> of_state(p.size(), std::vector<double>(parameters(), 0));
    of_state[0][kSliding] = p[0];
    if (model_ != DynamicModel::dahl) {
      of_state[1][kSliding] = p[1];
      of_state[1][kRatio] = p[0];
      of_state[2][kStribeckSpeed] = p[2];
    }
    if (model_ == DynamicModel::maxwell_slip) {
      of_state[0][kGrowth] = static_cast<double>(i) * p[0];
      of_state[1][kGrowth] = static_cast<double>(i) * p[1];
      of_state[3][kAttraction] = p[3];
    }
    slopes.push_back(std::move(of_state));
  }
  return slopes;
}

std::vector<double> DynamicFeatures::at_rows(const std::vector<double>& along_motion) const {
  std::vector<double> taken;
  taken.reserve(rows_.size());
  for (const std::size_t row : rows_) taken.push_back(along_motion[data_.motion_row[row]]);
  return taken;
}

bool DynamicFeatures::evaluate(std::span<const double> theta, std::span<double> features) {
  const std::vector<StateDeclaration> all = states(theta);
  if (!budget_.spend(kStateNodes * all.size() * data_.motion.rows())) return false;
  const std::size_t n = rows_.size();
  std::vector<double> along(data_.motion.rows());
  std::size_t next = 0;
  const auto column = [&] { return features.subspan(n * next++, n); };
  for (const StateDeclaration& state : all) {
    state_column(state, data_.motion, along);
    const std::vector<double> z = at_rows(along);
    std::ranges::copy(z, column().begin());
    if (terms_.load) {
      std::ranges::transform(z, load_size_, column().begin(), std::multiplies<>());
    }
    if (terms_.asymmetric) {
      std::ranges::transform(z, column().begin(), [](double x) { return std::abs(x); });
    }
    if (model_ == DynamicModel::lugre) write_rate(state, velocity_, z, column());
  }
  for (const std::vector<double>& linear : linear_) std::ranges::copy(linear, column().begin());
  return true;
}

bool DynamicFeatures::differentiate(std::span<const double> theta, std::span<double> slopes) {
  const std::vector<StateDeclaration> all = states(theta);
  const std::size_t p = parameters();
  if (!budget_.spend((p + 1) * kStateNodes * all.size() * data_.motion.rows())) return false;
  const auto by_theta = parameter_slopes(theta);
  const std::size_t n = rows_.size();
  std::ranges::fill(slopes, 0.0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const StateSensitivities found = state_sensitivities(all[i], data_.motion);
    const std::vector<double> z = at_rows(found.z);
    const std::size_t first = i * (own_features() / all.size());
    for (std::size_t j = 0; j < p; ++j) {
      std::vector<double> slope(n, 0);
      for (std::size_t k = 0; k < all[i].parameters.size(); ++k) {
        const double share = by_theta[i][k][j];
        if (share == 0) continue;
        const std::vector<double> by_k = at_rows(found.by_parameter[k]);
        for (std::size_t r = 0; r < n; ++r) slope[r] += share * by_k[r];
      }
      std::size_t next = first;
      const auto column = [&] { return slopes.subspan((j * features() + next++) * n, n); };
      std::ranges::copy(slope, column().begin());
      if (terms_.load) {
        std::ranges::transform(slope, load_size_, column().begin(), std::multiplies<>());
      }
      if (terms_.asymmetric) {
        std::ranges::transform(slope, z, column().begin(),
                               [](double dz, double at) { return dz * sign(at); });
      }
      if (model_ == DynamicModel::lugre) {
        write_rate_slope(all[i], by_theta[i], j, velocity_, z, slope, column());
      }
    }
  }
  return true;
}

SeparableOptions DynamicFeatures::options() const {
  SeparableOptions options;
  const MotionScales scales = scales_of(data_.motion, inputs_.velocity, velocity_);
  const double step = scales.step_travel;
  const double widest = std::max(scales.span, 10 * step);
  const double top = scales.top_speed;
  const double seconds = scales.step_seconds;
  const auto log = [](double x) { return elementary::log(std::max(x, 1e-300)); };
  options.low = {log(0.02 * step), 1, log(1e-3 * top), 0.1, log(0.1 * seconds)};
  options.high = {log(widest), kMostRatio, log(top), 2, log(1e3 * seconds)};
  options.low.resize(parameters());
  options.high.resize(parameters());
  const bool has_curve = model_ != DynamicModel::dahl;
  const bool has_elements = model_ == DynamicModel::maxwell_slip;
  const double deepest = log(has_elements ? 0.02 * widest : 0.2 * widest);
  for (const double sliding : steps_of(log(0.1 * step), deepest, has_elements ? 6 : 10)) {
    for (const double ratio : has_curve ? std::vector<double>{1.2, 2.0} : std::vector<double>{1}) {
      for (const double share :
           has_curve ? std::vector<double>{0.02, 0.1, 0.4} : std::vector<double>{1}) {
        for (const double growth :
             has_elements ? std::vector<double>{0.5, 1.0} : std::vector<double>{0}) {
          options.starts.push_back({sliding, ratio, log(share * top), growth, log(5 * seconds)});
          options.starts.back().resize(parameters());
        }
      }
    }
  }
  options.non_negative.assign(features(), 0);
  const std::size_t each = own_features() / state_count();
  for (std::size_t i = 0; i < state_count(); ++i) {
    options.non_negative[i * each] = 1;
  }
  if (model_ == DynamicModel::lugre) options.non_negative[own_features() - 1] = 1;
  return options;
}

std::vector<double> DynamicFeatures::start_influence(std::span<const double> theta) const {
  std::vector<double> largest(rows_.size(), 0);
  for (const StateDeclaration& state : states(theta)) {
    const auto left = at_rows(state_sensitivities(state, data_.motion).start_influence);
    for (std::size_t r = 0; r < left.size(); ++r) largest[r] = std::max(largest[r], left[r]);
  }
  return largest;
}

Expression DynamicFeatures::formula(std::span<const double> theta,
                                    std::span<const double> coefficients) const {
  using namespace build;
  const std::vector<StateDeclaration> all = states(theta);
  const Expression v = input(inputs_.velocity);
  Expression sum;
  std::size_t next = 0;
  const auto add = [&](const Expression& feature) {
    const double coefficient = coefficients[next++];
    if (coefficient != 0) sum = sum_of(sum, constant(coefficient) * feature);
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Expression z = input(data_.inputs.size() + i);
    const std::vector<double>& p = all[i].parameters;
    add(z);
    if (terms_.load) add(z * function(Op::abs, input(*load_)));
    if (terms_.asymmetric) add(function(Op::abs, z));
    if (model_ != DynamicModel::lugre) continue;
    const Expression curve =
        constant(p[0]) + constant(p[1] - p[0]) * function(Op::exp, -power(v / constant(p[2]), 2));
    add(v - function(Op::abs, v) * z / curve);
  }
  add(v);
  if (terms_.asymmetric) add(function(Op::abs, v));
  if (inputs_.acceleration) add(input(*inputs_.acceleration));
  if (load_) add(input(*load_));
  if (terms_.offset && coefficients[next] != 0) sum = sum_of(sum, constant(coefficients[next]));
  return sum.empty() ? constant(0) : sum;
}

}  // namespace tribench
