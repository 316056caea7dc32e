// SPDX-License-Identifier: MIT
//
// The static friction model as numbers: rows, parameters, value, squared error and its gradient.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/fitting/objective.hpp"
#include "algorithms/model_based/friction_inputs.hpp"
#include "algorithms/regressor.hpp"

namespace tribench {

// One set of parameters; all torques in the target's unit.
struct StribeckBranch {
  double coulomb = 0;            // Fc
  double breakaway_excess = 0;   // Fs - Fc
  double stribeck_velocity = 1;  // vs
  double exponent = 2;           // delta
  double viscous = 0;            // Fv
};
inline constexpr std::size_t kBranchParameters = 5;

// Of a branch's parameters; viscous friction has none.
struct BranchRanges {
  ConstantRange coulomb;
  ConstantRange breakaway_excess;
  ConstantRange stribeck_velocity;
  ConstantRange exponent;
};

// A row of data belongs to one branch: the only one, or that of its direction (0 for v >= 0).
struct StribeckRows {
  std::vector<double> velocity;
  std::vector<double> sign;
  std::vector<double> acceleration;  // empty without the inertia term
  std::vector<double> target;
  std::vector<std::size_t> branch;

  std::size_t size() const { return target.size(); }
};

struct StribeckModel {
  std::vector<StribeckBranch> branches;  // 1, or 2: positive and negative direction
  bool has_offset = false;
  bool has_inertia = false;
  double offset = 0;
  double inertia = 0;

  // Branches in order (Fc, Fs - Fc, vs, delta, Fv), then offset and inertia where there are any.
  std::vector<double> parameters() const;
  void set_parameters(std::span<const double> values);
  std::size_t parameter_count() const {
    return kBranchParameters * branches.size() + (has_offset ? 1U : 0U) + (has_inertia ? 1U : 0U);
  }

  // sum of squared errors; gradient with respect to the parameters where asked for.
  double sum_squares(const StribeckRows& rows, std::span<double> gradient) const;
  // As a formula over the problem's inputs; terms that are exactly 0 are left out.
  Expression formula(const FrictionInputs& inputs) const;
  // Of the formula's constants, in the order of its tape.
  std::vector<ConstantRange> formula_ranges(const BranchRanges& ranges) const;
};

// The mean squared error of `trial` over the rows with its gradient, for a minimiser. Every call
// spends `nodes_per_row`; where the budget has no more, `stop` is set and the answer is NaN. What
// is referred to must outlive it.
Objective mean_squares(StribeckModel& trial, const StribeckRows& rows, Budget& budget,
                       std::uint64_t nodes_per_row, bool& stop);

// exp(-(v / vs)^delta) of each speed v >= 0, in place.
void decay_of_each(std::span<double> speeds, double stribeck_velocity, double exponent);

}  // namespace tribench
