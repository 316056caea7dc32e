// SPDX-License-Identifier: MIT
//
// Laws in fewer variables, read off the slopes of a polynomial through the rows (surrogate.hpp):
//
//   scaling      T(prod x_j^(s d_j)) = exp(s c) T: T(y) = prod x_i^a_i * g(u), each u a product of
//                powers; any number of variables may be left, where collapse.hpp finds one
//   shift        y of a difference or a sum of two inputs
//   a term       T(y) = c x_j^p + g(the others)
//
// with T one of y, log y, y^2, 1/y, 1/y^2. Scalings are those of log y, and of the power of y that
// a polynomial is nearest to, where it is nearer to that: near a pole or a root. What is found is
// as exact as its small whole exponents; whether it is true is for the caller to see by what
// becomes of g.
//
// Source: pi theorem, Buckingham 1914, from the data alone; symmetries by gradients, Udrescu et al.
// 2020 (AI Feynman 2.0), there with a neural network.
#pragma once

#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"
#include "algorithms/relay/target_forms.hpp"

namespace tribench::relay {

struct Reduction {
  TargetForm form = TargetForm::plain;
  bool is_sum = false;             // T(y) = outer + g(inputs), else outer * g(inputs)
  Expression outer;                // over the problem's inputs
  std::vector<Expression> inputs;  // of g, over the problem's inputs; at least one
  bool is_guess = false;           // no slope says so

  bool operator==(const Reduction&) const = default;
};

struct Reductions {
  // The least error of the surrogates: where a reduction is true, the next one is smaller.
  double roughness;
  std::vector<Reduction> list;  // those with the fewest inputs left first
};

// Whether, where no scaling shows, some are tried: one or two inputs, small exponents.
enum class Guesses { no, yes };

// None where the rows are too few or too noisy for slopes. Cost: four surrogates.
Reductions find_reductions(const LogRows& rows, Guesses guesses, Budget& budget);

}  // namespace tribench::relay
