// SPDX-License-Identifier: MIT
//
// How many numbers a formula's shape leaves to be chosen: what the evidence charges for, whatever
// was chosen.
//
// A constant that is written twice over (2 * (3 * x)) is one number, and a term without a
// coefficient has one all the same, chosen to be 1: in v + sgn_v the two are of different units,
// and that a search put 1 there was a choice like any other. So with D(e) the numbers of the family
// "c e" with every term's coefficient free:
//
//   constant, variable      1
//   a + b, a - b            D(a) + D(b)         every term has its own scale
//   a * b, a / b            D(a) + D(b) - 1     the scales of both sides are one
//   -a, |a|, sqrt a, sgn a  D(a)                a scale goes through
//   a ^ n                   D(a); D(a) + D(b) where the exponent is no constant
//   exp a                   1 + D(a), less 1 where a has a constant term: it is a scale
//   any other f(a)          1 + D(a)
//
// An upper bound of the rank of the Jacobian of that family: identities between inputs (the square
// of a sign) are not known to it.
#pragma once

#include <cstddef>

#include "algorithms/expression/expression.hpp"

namespace tribench {

std::size_t shape_dimension(const Expression& formula);

}  // namespace tribench
