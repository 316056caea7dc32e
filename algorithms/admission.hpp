// SPDX-License-Identifier: MIT
//
// Which formulas a method may offer: those that keep to the operator set and, where the set admits
// no others (`paper+safe_div`), are proved free of singularities over the inputs' box.
#pragma once

#include <span>

#include "algorithms/expression/input_box.hpp"
#include "algorithms/regressor.hpp"

namespace tribench {

// The box of the inputs; a sign whose input is not among them ranges on its own.
InputBox input_box(std::span<const Input> inputs);

// For a front, not for every formula of a search: a proof takes microseconds, seldom milliseconds.
class Admission {
 public:
  Admission(const OperatorSet& operators, std::span<const Input> inputs)
      : operators_(operators), box_(input_box(inputs)) {}
  explicit Admission(const FitContext& context)
      : Admission(context.operators, context.data.inputs) {}

  bool admits(const Expression& formula) const {
    return operators_.admits(formula) && is_safe(formula);
  }
  // True where the set asks for no proof.
  bool is_safe(const Expression& formula) const;

 private:
  const OperatorSet& operators_;
  InputBox box_;
};

}  // namespace tribench
