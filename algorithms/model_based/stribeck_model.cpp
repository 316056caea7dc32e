// SPDX-License-Identifier: MIT
#include "algorithms/model_based/stribeck_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/build.hpp"
#include "foundation/elementary.hpp"

namespace tribench {

void decay_of_each(std::span<double> speeds, double stribeck_velocity, double exponent) {
  for (double& v : speeds) v /= stribeck_velocity;
  elementary::pow_of_each(speeds, exponent);
  for (double& u : speeds) u = -u;
  elementary::exp_of_each(speeds);
}

std::vector<double> StribeckModel::parameters() const {
  std::vector<double> values;
  for (const StribeckBranch& b : branches) {
    values.insert(values.end(),
                  {b.coulomb, b.breakaway_excess, b.stribeck_velocity, b.exponent, b.viscous});
  }
  if (has_offset) values.push_back(offset);
  if (has_inertia) values.push_back(inertia);
  return values;
}

void StribeckModel::set_parameters(std::span<const double> values) {
  std::size_t next = 0;
  for (StribeckBranch& b : branches) {
    b = {values[next], values[next + 1], values[next + 2], values[next + 3], values[next + 4]};
    next += kBranchParameters;
  }
  if (has_offset) offset = values[next++];
  if (has_inertia) inertia = values[next];
}

double StribeckModel::sum_squares(const StribeckRows& rows, std::span<double> gradient) const {
  std::ranges::fill(gradient, 0.0);
  double sum = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::size_t which = rows.branch[row];
    const StribeckBranch& b = branches[which];
    const double v = rows.velocity[row];
    const double ratio = std::abs(v / b.stribeck_velocity);
    const double power = elementary::pow(ratio, b.exponent);
    const double decay = elementary::exp(-power);
    double error = rows.sign[row] * (b.coulomb + b.breakaway_excess * decay) + b.viscous * v -
                   rows.target[row];
    if (has_offset) error += offset;
    if (has_inertia) error += inertia * rows.acceleration[row];
    sum += error * error;
    if (gradient.empty()) continue;
    // d exp(-u) = -exp(-u) du, u = |v / vs|^delta; u log|v / vs| tends to 0 with v.
    const double twice = 2 * error;
    const double slope = twice * rows.sign[row] * b.breakaway_excess * decay;
    double* g = gradient.data() + which * kBranchParameters;
    g[0] += twice * rows.sign[row];
    g[1] += twice * rows.sign[row] * decay;
    if (power > 0 && std::isfinite(power)) {
      g[2] += slope * power * b.exponent / b.stribeck_velocity;
      g[3] -= slope * power * elementary::log(ratio);
    }
    g[4] += twice * v;
    std::size_t next = kBranchParameters * branches.size();
    if (has_offset) gradient[next++] += twice;
    if (has_inertia) gradient[next] += twice * rows.acceleration[row];
  }
  return sum;
}

namespace {

using namespace build;

// sgn(v) (Fc + (Fs - Fc) exp(-|v / vs|^delta)) + Fv v
Expression branch_formula(const StribeckBranch& b, const FrictionInputs& inputs) {
  const Expression velocity = input(inputs.velocity);
  Expression level = constant(b.coulomb);
  if (b.breakaway_excess != 0) {
    const Expression ratio = function(Op::abs, velocity / constant(b.stribeck_velocity));
    const Expression decay = function(Op::exp, -power(ratio, b.exponent));
    level = level + constant(b.breakaway_excess) * decay;
  }
  return inputs.sign() * level + constant(b.viscous) * velocity;
}

void add_branch_ranges(const StribeckBranch& b, const BranchRanges& ranges,
                       std::vector<ConstantRange>& all) {
  all.push_back(ranges.coulomb);
  if (b.breakaway_excess != 0) {
    all.insert(all.end(), {ranges.breakaway_excess, ranges.stribeck_velocity, ranges.exponent});
  }
  all.push_back({});
}

}  // namespace

Expression StribeckModel::formula(const FrictionInputs& inputs) const {
  Expression result = branch_formula(branches[0], inputs);
  if (branches.size() == 2) {
    // (1 + s) / 2 and (1 - s) / 2 choose the direction; both branches are 0 at rest.
    const Expression half_sign = constant(0.5) * inputs.sign();
    result = result * (constant(0.5) + half_sign) +
             branch_formula(branches[1], inputs) * (constant(0.5) - half_sign);
  }
  if (has_inertia) result = result + constant(inertia) * input(*inputs.acceleration);
  if (has_offset) result = result + constant(offset);
  return result;
}

std::vector<ConstantRange> StribeckModel::formula_ranges(const BranchRanges& ranges) const {
  constexpr ConstantRange kHalf{0.5, 0.5};
  std::vector<ConstantRange> all;
  for (const StribeckBranch& branch : branches) {
    add_branch_ranges(branch, ranges, all);
    if (branches.size() == 2) all.insert(all.end(), {kHalf, kHalf});
  }
  all.resize(all.size() + (has_inertia ? 1U : 0U) + (has_offset ? 1U : 0U));
  return all;
}

Objective mean_squares(StribeckModel& trial, const StribeckRows& rows, Budget& budget,
                       std::uint64_t nodes_per_row, bool& stop) {
  const double scale = 1 / static_cast<double>(rows.size());
  return [&trial, &rows, &budget, &stop, nodes_per_row, scale](std::span<const double> x,
                                                               std::span<double> gradient) {
    if (!budget.spend(nodes_per_row * rows.size())) {
      stop = true;
      return std::numeric_limits<double>::quiet_NaN();
    }
    trial.set_parameters(x);
    const double value = trial.sum_squares(rows, gradient);
    for (double& g : gradient) g *= scale;
    return value * scale;
  };
}

}  // namespace tribench
