// SPDX-License-Identifier: MIT
#include "algorithms/relay/unit_function.hpp"

#include <cmath>

#include "algorithms/expression/build.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {

using namespace build;

bool UnitFunction::is_written_with(const OperatorSet& operators) const {
  return operators.admits(formula(input(0)));
}

double UnitFunction::value(double z) const {
  switch (kind) {
    case Kind::exponential:
      return elementary::exp(z);
    case Kind::tanh:
      return elementary::tanh(z);
    case Kind::atan:
      return elementary::atan(z);
    case Kind::logarithm:
      return elementary::log(1 + z);
    case Kind::power:
      return exponent == 0.5 ? std::sqrt(1 + z) : elementary::pow(1 + z, exponent);
    case Kind::cosh:
      return elementary::exp(z) + elementary::exp(-z);
    case Kind::sinh:
      return elementary::exp(z) - elementary::exp(-z);
    case Kind::sine:
      return elementary::sin(z);
    case Kind::cosine:
      return elementary::cos(z);
  }
  return NAN;
}

Expression UnitFunction::formula(const Expression& z) const {
  switch (kind) {
    case Kind::exponential:
      return function(Op::exp, z);
    case Kind::tanh:
      return function(Op::tanh, z);
    case Kind::atan:
      return function(Op::atan, z);
    case Kind::logarithm:
      return function(Op::log, constant(1) + z);
    case Kind::power:
      return exponent == 0.5 ? function(Op::sqrt, constant(1) + z)
                             : power(constant(1) + z, exponent);
    case Kind::cosh:
      return function(Op::exp, z) + function(Op::exp, -z);
    case Kind::sinh:
      return function(Op::exp, z) - function(Op::exp, -z);
    case Kind::sine:
      return function(Op::sin, z);
    case Kind::cosine:
      return function(Op::cos, z);
  }
  return {};
}

}  // namespace tribench::relay
