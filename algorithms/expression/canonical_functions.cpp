// SPDX-License-Identifier: MIT
//
// Powers and functions in canonical form: what folds, and which signs come out.
#include <cmath>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/evaluate.hpp"

namespace tribench {

std::uint32_t Canonicalizer::power(std::uint32_t base, std::uint32_t exponent) {
  const Item index = forms_.at(exponent);
  if (index.kind == Kind::constant) {
    const double n = index.value;
    if (n == 0 && forms_.is_finite(base)) return forms_.constant(1);
    if (n == 1) return base;
    if (forms_.at(base).kind == Kind::constant) {
      const double folded = apply(Op::pow, forms_.at(base).value, n);
      if (std::isfinite(folded)) return forms_.constant(folded);
    }
    if (n != 0 && is_product_power(n)) {
      scratch_.clear();
      double coefficient = 1;
      add_factors(base, static_cast<int>(n), coefficient);
      return finish_product(coefficient);
    }
  }
  return forms_.opaque(Op::pow, base, exponent);
}

std::uint32_t Canonicalizer::function(Op op, std::uint32_t argument) {
  const Item item = forms_.at(argument);
  if (item.kind == Kind::constant) {
    const double value = apply(op, item.value);
    if (std::isfinite(value)) return forms_.constant(value);
  }
  const bool is_even = op == Op::cos || op == Op::abs;
  const bool is_odd = op == Op::sin || op == Op::tanh || op == Op::atan || op == Op::sgn;
  if ((is_even || is_odd) && forms_.leads_negative(item)) {
    const std::uint32_t flipped = function(op, scaled(argument, -1));
    return is_odd ? scaled(flipped, -1) : flipped;
  }
  if (op == Op::abs) return magnitude(argument);
  if (op == Op::sgn && item.op == Op::sgn) return argument;
  return forms_.opaque(op, argument, argument);
}

// |x|, where the argument does not lead with a minus.
std::uint32_t Canonicalizer::magnitude(std::uint32_t argument) {
  const Item item = forms_.at(argument);
  if (item.op == Op::abs || item.op == Op::sqrt || item.op == Op::exp) return argument;
  if (item.kind == Kind::product && item.value != 1) {
    return scaled(magnitude(forms_.unit_of(argument)), item.value);
  }
  return forms_.opaque(Op::abs, argument, argument);
}

}  // namespace tribench
