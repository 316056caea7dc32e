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

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/interval.hpp"
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

  const Expression& formula() const { return formula_; }
  // The columns that occur in the formula, ascending.
  const std::vector<std::size_t>& used_columns() const { return used_; }

 private:
  using Values = std::vector<DecoratedInterval>;

  // The natural extension of node i from its children's bounds in `values`.
  DecoratedInterval extend(std::size_t i, std::span<const Interval> box,
                           const Values& values) const;
  // Fills `values` up to the first node that may fail, whose place it returns (or the size).
  std::size_t pass(std::span<const Interval> box, Values& values) const;
  void choose_active(std::span<const Interval> box);
  void pass_points(std::span<const Interval> box);
  void bound_error(std::size_t i);
  double unary_error(std::size_t i) const;
  double binary_error(std::size_t i) const;
  double rounding_of(std::size_t i) const;
  bool scales_exactly(std::size_t i) const;
  void bound_gradient(std::size_t i);
  Interval unary_slope(std::size_t i) const;
  void power_gradient(std::size_t i);
  void refine(std::size_t i, std::span<const Interval> box);
  bool meet_corners(std::size_t i, Interval& range) const;
  void meet_polynomial(std::size_t i, std::span<const Interval> box, Interval& range) const;
  Interval* gradient(std::size_t i) { return gradients_.data() + i * active_.size(); }
  const Interval* gradient(std::size_t i) const { return gradients_.data() + i * active_.size(); }

  static constexpr std::size_t kMaxCornerInputs = 2;

  Expression formula_;
  std::vector<bool> same_operands_;  // binary nodes whose operands are the same formula
  std::vector<std::optional<Polynomial>> polynomials_;  // by node; empty until sharpened
  std::vector<std::size_t> used_;                       // columns that occur, ascending
  std::vector<std::size_t> active_;                     // those whose range is not a point
  Values values_;
  Interval real_root_;
  std::size_t failed_ = 0;
  std::vector<double> errors_;
  double widening_ = 0;              // of the node at hand
  std::vector<Interval> gradients_;  // node-major, one per active column
  std::vector<Interval> point_box_;  // the box's centre
  std::vector<Interval> corner_box_;
  Values centre_;
  std::size_t centre_failed_ = 0;
  std::vector<Values> corners_;  // bit j of the index: active column j at its upper end
  std::vector<std::size_t> corners_failed_;
};

}  // namespace tribench
