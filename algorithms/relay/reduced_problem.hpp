// SPDX-License-Identifier: MIT
//
// A problem in fewer variables (reduction.hpp) as data that any method fits, and the way back from
// what it finds to a formula of the fit's own inputs.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "algorithms/finite_rows.hpp"
#include "algorithms/regressor.hpp"
#include "algorithms/relay/reduction.hpp"

namespace tribench::relay {

class ReducedProblem {
 public:
  // The whole problem, nothing reduced yet.
  ReducedProblem(std::span<const Input> inputs, const FiniteRows& rows);
  // `parent` with one reduction more. Rows on which it is not finite are NaN, which FiniteRows and
  // methods leave out.
  ReducedProblem(const ReducedProblem& parent, Reduction reduction);

  TrainingData data() const { return {inputs_, pointers_, target_, {}}; }
  std::size_t inputs() const { return inputs_.size(); }
  // How many reductions away from the whole problem.
  std::size_t depth() const { return steps_.size(); }

  // Whether the last reduction was a guess.
  bool is_guess() const { return !steps_.empty() && steps_.back().reduction.is_guess; }
  // Above it the last reduction was not true: the problem before it is smoother.
  double most_roughness() const { return most_roughness_; }
  void set_roughness(double roughness) { roughness_ = roughness; }

  // Reached on another way: to rounding, the same inputs and target.
  bool is_same_as(const ReducedProblem& other) const;

  // A formula of this problem's inputs as one of the whole problem's.
  Expression restored(Expression found) const;

  ReducedProblem(const ReducedProblem&) = delete;
  ReducedProblem& operator=(const ReducedProblem&) = delete;
  ReducedProblem(ReducedProblem&&) = default;
  ReducedProblem& operator=(ReducedProblem&&) = default;

 private:
  struct Step {
    Reduction reduction;
    double sign = 1;  // of the target before it, for forms that do not keep it
  };

  std::vector<Step> steps_;
  std::vector<Input> inputs_;
  std::vector<std::vector<double>> columns_;
  std::vector<const double*> pointers_;
  std::vector<double> target_;
  double roughness_ = HUGE_VAL;  // of this problem's surrogates (surrogate.hpp)
  double most_roughness_ = HUGE_VAL;
};

}  // namespace tribench::relay
