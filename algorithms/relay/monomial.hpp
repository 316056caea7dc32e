// SPDX-License-Identifier: MIT
//
// Products of simple powers of inputs, as the searches that list them all need them: their values
// on the rows and how they are written. Powers are +-1/2, +-1 and +-2, no others.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

struct Monomial {
  std::vector<std::pair<std::size_t, double>> powers;  // input, exponent; 1 where there are none

  // Finite on all rows: no root of what is negative, no division by what is 0.
  bool is_defined(const LogRows& rows) const;
  std::vector<double> values(const LogRows& rows) const;
  Expression times(double factor) const;
};

// Every way to give `powers`, one of these lists after the other, to as many different inputs,
// these in increasing order; those that the rows define.
std::vector<Monomial> monomials(const std::vector<std::vector<double>>& powers,
                                const LogRows& rows);

}  // namespace tribench::relay
