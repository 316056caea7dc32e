// SPDX-License-Identifier: MIT
//
// Laws that are a sum, or a product, of parts with inputs of their own: y = f(a, b) + g(c) + ...
//
// Whether a law is one shows in polynomials through the rows (surrogate.hpp): without the terms
// that two parts share it is no worse. What the other parts leave of the target is a part's own
// target, as exact as their polynomials are, or the formulas found in place of these: a problem in
// fewer inputs under a little noise, for what is likely there, for another method, or for this
// search again. What is found of each part is joined; the caller fits all constants together, and
// what was no law shows then.
//
// Not for parts that share an input.
//
// Source: separability, Udrescu et al. 2020 (AI Feynman 2.0), there with a neural network.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "algorithms/regressor.hpp"
#include "algorithms/relay/log_rows.hpp"
#include "algorithms/relay/surrogate.hpp"
#include "algorithms/relay/target_forms.hpp"

namespace tribench::relay {

struct Separation {
  TargetForm form = TargetForm::plain;      // the sum is T(y): y or log |y|
  Parts parts;                              // two or more, those of the fewest inputs first
  std::vector<double> target;               // T(y) on the rows
  std::vector<std::vector<double>> values;  // of each part's polynomial, without the constant
  double error = 0;                         // of the sum of them, of the spread of T
};

// The parts whose polynomials err least; none where one polynomial in all inputs errs less. Cost: a
// surrogate for T, for each number of parts and each pair of inputs.
std::optional<Separation> find_separation(const LogRows& rows, Budget& budget);

class PartSearch {
 public:
  // All are kept by reference.
  PartSearch(const FitContext& context, const Regressor& solver)
      : context_(context), solver_(solver) {}

  // Joined parts with constants near their best, the likeliest first.
  std::vector<Expression> run(const LogRows& rows, const Separation& separation,
                              Budget& budget) const;

 private:
  std::vector<Expression> joined(const LogRows& rows, Separation separation,
                                 std::span<const Input> inputs, int depth, Budget& budget) const;
  // The likeliest formulas of a problem of its own.
  struct Solution {
    std::vector<Expression> formulas;
    bool leaves_noise = false;  // the first of them
  };
  Solution solved(const TrainingData& data, int depth, Budget& budget) const;

  const FitContext& context_;
  const Regressor& solver_;
};

}  // namespace tribench::relay
