// SPDX-License-Identifier: MIT
//
// A trained model of a family as a formula over the problem's inputs: exactly the function that was
// trained, in the operators that are allowed.
#pragma once

#include <span>

#include "algorithms/expression/operator_set.hpp"
#include "algorithms/parfam/projection.hpp"

namespace tribench::parfam {

// One point of a family; parameters as Projection has them, over inputs divided by their scales.
struct TrainedModel {
  Structure structure;
  std::vector<double> inner;
  std::vector<double> coefficients;
  double sum_squares = 0;
};

// scales[j]: what input j was divided by. Where abs is not allowed, |u| is written sqrt(u^2).
Expression formula_of(const TrainedModel& model, std::span<const double> scales,
                      Denominators denominators, const OperatorSet& operators);

// |u| in the operators that are allowed.
Expression magnitude(const Expression& u, const OperatorSet& operators);

}  // namespace tribench::parfam
