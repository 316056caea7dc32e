// SPDX-License-Identifier: MIT
//
// The functions of one scaled argument that laws are made of, for the searches that look for the
// scale: their values, and how they are written with the operators there are.
#pragma once

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"

namespace tribench::relay {

// exp z, tanh z, atan z, log(1 + z), (1 + z)^exponent, e^z + e^-z, e^z - e^-z, sin z, cos z.
struct UnitFunction {
  enum class Kind { exponential, tanh, atan, logarithm, power, cosh, sinh, sine, cosine };
  Kind kind;
  double exponent = 1;  // of a power

  // Whether the operators can write it.
  bool is_written_with(const OperatorSet& operators) const;
  // NaN where 1 + z is negative below a logarithm or a power that is no whole number.
  double value(double z) const;
  Expression formula(const Expression& z) const;
};

}  // namespace tribench::relay
