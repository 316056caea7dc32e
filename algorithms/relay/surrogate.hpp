// SPDX-License-Identifier: MIT
//
// A polynomial through the rows, for its slopes: what a law is symmetric in shows in them long
// before the law is known. Of as high a degree as the rows determine, in the inputs or, where that
// is better on rows held out, in the logarithms of those that are positive.
//
// A sum of polynomials in parts of the inputs says, by its error, whether the law is such a sum.
//
// Not for predictions: between and beyond the rows it says nothing that anyone should use.
#pragma once

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

using Parts = std::vector<std::vector<std::size_t>>;  // of the inputs' places, each in one

class Surrogate {
 public:
  // `target`: finite values on the rows. With more than 12 inputs, fewer than 40 rows, or a budget
  // that does not allow it, there is none, and the error is infinite.
  // Cost: two regressions of at most 140 columns; some 20 ms for 500 rows.
  Surrogate(const LogRows& rows, std::span<const double> target, Budget& budget);
  // A sum of polynomials, each in the inputs of one part; logarithms where `whole` has them.
  Surrogate(const LogRows& rows, std::span<const double> target, const Parts& parts,
            const Surrogate& whole, Budget& budget);

  // In a few inputs alone, of the highest degree with at most so many terms.
  Surrogate(const std::vector<Factor>& inputs, std::span<const double> target,
            std::size_t most_terms, Budget& budget);

  // Root mean square on every sixth row, which is held out, of the target's own about its mean.
  double error() const { return error_; }
  // Of the target by input j, on the rows.
  const std::vector<double>& slope(std::size_t j) const { return slopes_[j]; }
  // The squares of the coefficients of terms with both inputs.
  double shared(std::size_t i, std::size_t j) const { return shared_[i * slopes_.size() + j]; }
  // The polynomial of part k on the rows, without the constant.
  const std::vector<double>& part(std::size_t k) const { return parts_[k]; }

 private:
  class Polynomial;

  // The better of two degrees.
  static std::optional<Polynomial> fitted(const LogRows& rows, std::span<const double> target,
                                          const Parts& parts, std::initializer_list<bool> by_logs,
                                          Budget& budget);

  double error_ = HUGE_VAL;
  bool by_logs_ = false;
  std::vector<std::vector<double>> slopes_;
  std::vector<double> shared_;
  std::vector<std::vector<double>> parts_;
};

// Whether a polynomial has nothing to say of what a formula leaves.
bool leaves_noise(const Expression& formula, const LogRows& rows, Budget& budget);

}  // namespace tribench::relay
