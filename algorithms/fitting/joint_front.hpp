// SPDX-License-Identifier: MIT
//
// One front of several searches on the same rows, and one formula to stand for it: the exact one
// where there is one (exact_choice.hpp), else of the formulas that the searches stood for the one
// with the most evidence (evidence.hpp).
//
// Not for fronts of different rows: their errors cannot be compared.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

class JointFront {
 public:
  // Finite rows, kept by reference.
  JointFront(const Inputs& inputs, std::span<const double> target);

  // `front` is not empty, `chosen` a place in it. One evaluation a formula of both.
  void add(std::span<const Expression> front, std::size_t chosen);

  // By increasing paper complexity, each with less error than all before it; the chosen one stays.
  const std::vector<Expression>& formulas() const { return formulas_; }
  std::size_t chosen() const { return chosen_; }

  // Whether a formula explains the rows to rounding: more search is in vain.
  bool is_explained() const { return is_explained_; }

 private:
  double mean_square(const Expression& formula);
  double against(const Expression& formula);

  Inputs inputs_;
  std::span<const double> target_;
  double zero_loss_ = 0;
  Evaluator evaluator_;
  std::vector<Expression> formulas_;
  std::size_t chosen_ = 0;
  bool is_explained_ = false;
};

}  // namespace tribench
