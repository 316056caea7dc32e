// SPDX-License-Identifier: MIT
//
// Bounds of every node of a formula over a box: what our evaluator computes there in double
// precision and, at once, the real value. Two strengths:
//
//   bound    the natural interval extension: cheap, loose where an input occurs more than once
//   sharpen  node by node, the natural extension intersected with the mean-value form
//            f(m) + F'(X)(X - m) and, where the interval gradient has one sign in every input (up
//            to two of them), with the values at the two extreme corners; and polynomials in one
//            variable with their exact range (polynomial_range.hpp). These bound the real value; a
//            running bound of the rounding errors of the evaluation makes them bounds of the
//            computed value too.
//
// Sources: Moore, Kearfott, Cloud 2009, "Introduction to Interval Analysis", chapter 6 (mean-value
// form, monotonicity); Higham 2002, "Accuracy and Stability of Numerical Algorithms", section 3.3
// (running error analysis).
//
// Not a proof by itself: `prove_free` (singularity.hpp) splits the box until bounds suffice. Keeps
// its workspace; one per thread. Cost: bound O(nodes), sharpen O(nodes * (4 + inputs)).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/box_points.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/interval.hpp"
#include "algorithms/expression/interval_gradient.hpp"
#include "algorithms/expression/natural_extension.hpp"
#include "algorithms/expression/polynomial_range.hpp"

namespace tribench {

class FormulaBounds {
 public:
  explicit FormulaBounds(const Expression& formula);

  // Both return whether every node is defined and finite on the whole box; where not,
  // failed_node() is the first node (in the tape's order) that may not be, and bounds are valid
  // for the nodes before it. box[j] is the range of variable j: bounded, low <= high.
  bool bound(std::span<const Interval> box);
  bool sharpen(std::span<const Interval> box);

  std::size_t failed_node() const { return failed_; }
  const DecoratedInterval& at(std::size_t node) const { return values_[node]; }
  const DecoratedInterval& root() const { return values_.back(); }

  // After `sharpen`: the range of the partial derivative (Clarke's, at a kink) of a node's real
  // value by a variable; [0, 0] by a variable whose range is a point.
  Interval derivative(std::size_t node, std::size_t variable) const;
  // After `sharpen`: |computed - real| of the node, anywhere in the box.
  double rounding_error(std::size_t node) const { return errors_[node]; }

  // After `sharpen`: the range of the formula's real value alone, without the rounding errors of
  // its evaluation.
  const Interval& real_root() const { return real_root_; }

  const Expression& formula() const { return extension_.formula(); }
  // The columns that occur in the formula, ascending.
  const std::vector<std::size_t>& used_columns() const { return used_; }

 private:
  void choose_active(std::span<const Interval> box);
  void bound_error(std::size_t i);
  double rounding_of(std::size_t i) const;
  void refine(std::size_t i, std::span<const Interval> box);
  void meet_polynomial(std::size_t i, std::span<const Interval> box, Interval& range) const;

  NaturalExtension extension_;
  std::vector<std::optional<Polynomial>> polynomials_;  // by node; empty until sharpened
  std::vector<std::size_t> used_;                       // columns that occur, ascending
  std::vector<std::size_t> active_;                     // those whose range is not a point
  NaturalExtension::Values values_;
  Interval real_root_;
  std::size_t failed_ = 0;
  std::vector<double> errors_;
  double widening_ = 0;  // of the node at hand
  IntervalGradient gradient_;
  BoxPoints points_;
};

// Bounds of the real value at one point.
Interval value_at(FormulaBounds& bounds, const std::vector<double>& point);

}  // namespace tribench
