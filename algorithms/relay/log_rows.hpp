// SPDX-License-Identifier: MIT
//
// Rows as laws of physics are written: products of powers, so that logarithms of sizes are sums.
// What the searches of this room share: the rows, the quantities products are made of, and how a
// product is written as a formula.
//
// Rows whose target is 0 are left out, and of more than `most` rows every k-th is taken: what is
// found is fitted and judged on all rows by the caller.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/finite_rows.hpp"

namespace tribench::relay {

// A quantity with its values on the rows.
struct Factor {
  Expression formula;
  std::vector<double> values;
  std::vector<double> logs;  // log |value|; empty where a value is 0
  bool changes_sign = false;

  bool has_logs() const { return !logs.empty(); }
};

Factor make_factor(Expression formula, std::vector<double> values);

class LogRows {
 public:
  LogRows(const FiniteRows& rows, std::size_t most);

  std::size_t rows() const { return target_.values.size(); }
  const std::vector<Factor>& inputs() const { return inputs_; }
  const Factor& target() const { return target_; }

  // An input that may be an angle or another number of order one, of which a sine or an exponential
  // means something.
  bool is_of_order_one(std::size_t j) const;
  // A part of one: a concentration, a probability, a rate of interest.
  bool is_share(std::size_t j) const;
  // Whether a sum of the two may mean something: sizes that overlap.
  bool are_alike(std::size_t i, std::size_t j) const;

 private:
  std::vector<Factor> inputs_;
  Factor target_;
};

// The factor's formula, with its values on the rows.
Factor factor_of(const Expression& formula, const LogRows& rows);

// constant * product of factors[k]^exponents[k], exponents multiples of 1/2 or any others; factors
// with exponent 0 are left out.
Expression product_of(double constant, std::span<const Expression> factors,
                      std::span<const double> exponents);

// The nearest multiple of a half.
double nearest_half(double exponent);

}  // namespace tribench::relay
