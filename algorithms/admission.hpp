// SPDX-License-Identifier: MIT
//
// Which formulas a method may offer: those that keep to the operator set and to the declared priors
// and, where the set admits no others (`paper+safe_div`), are proved free of singularities over the
// inputs' box.
#pragma once

#include <cstddef>
#include <span>

#include "algorithms/expression/input_box.hpp"
#include "algorithms/regressor.hpp"

namespace tribench {

// The box of the inputs; a sign whose input is not among them ranges on its own.
InputBox input_box(std::span<const Input> inputs);

// How often an input is multiplied by itself in a formula, through functions too: g has the degree
// 1, exp(g)*v*g the degree 2, g^3 the degree 3. A division counts both its sides; a power that is
// no positive whole constant counts as one of kUnboundedDegree.
inline constexpr int kUnboundedDegree = 1000;
int degree_in(const Expression& formula, std::size_t input);

// True where every input keeps to its max_degree. Cost: a pass for each input that has one.
bool keeps_priors(const Expression& formula, std::span<const Input> inputs);

// For a front, not for every formula of a search: a proof takes microseconds, seldom milliseconds.
class Admission {
 public:
  Admission(const OperatorSet& operators, std::span<const Input> inputs)
      : operators_(operators), inputs_(inputs), box_(input_box(inputs)) {}
  explicit Admission(const FitContext& context)
      : Admission(context.operators, context.data.inputs) {}

  bool admits(const Expression& formula) const {
    return operators_.admits(formula) && may_be_offered(formula);
  }
  // Keeps to the priors and, where the set asks for it, is proved free; for formulas that keep to
  // the set by the way they were made.
  bool may_be_offered(const Expression& formula) const;

 private:
  const OperatorSet& operators_;
  std::span<const Input> inputs_;
  InputBox box_;
};

}  // namespace tribench
