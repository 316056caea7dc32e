// SPDX-License-Identifier: MIT
//
// Least squares of small subsets of many columns, from one Gram matrix: all pairs, all pairs beside
// one of some marked columns, and the best of them grown column by column.
//
// What is left is computed from products of columns, so that it is exact to some 1e-5 of the target
// only: the caller fits what it takes again. Columns are scaled to unit length inside.
//
// Not parfam's best subsets, one a size by exchange: here an exact sum is looked for among hundreds
// that are nearly as good, of which exchange leaves one.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/budget.hpp"

namespace tribench::relay {

struct SparseSum {
  std::vector<std::size_t> terms;  // columns, in increasing order
  double left = HUGE_VAL;          // of the target's square; 1 without terms
};

class SubsetFits {
 public:
  // gram: products of the columns and, last, the target, (columns + 1)^2. Of the columns marked
  // `once` a sum has at most one: two multiples of the target, x and 1/x times it, come near to the
  // target whatever it is.
  SubsetFits(std::vector<double> gram, std::vector<char> once);

  // Each returns at most 300, those that leave least, the best first. Cost: a few flops a sum
  // looked at. The longer ones end where the seconds run out, with what they have.
  std::vector<SparseSum> best_pairs() const;
  // Of one marked column and two others; with the first marked ones, as many as take `most` steps.
  std::vector<SparseSum> best_with_one_marked(std::size_t most, Budget& budget) const;
  // Of each of `sums` and one further column.
  std::vector<SparseSum> grown(const std::vector<SparseSum>& sums, Budget& budget) const;

 private:
  class Best;

  // All pairs of `among` beside `terms`, which leave `left`; gram has unit diagonal, or 0 where
  // nothing is left of a column.
  void add_pairs(std::span<const std::size_t> among, const std::vector<double>& gram,
                 const std::vector<std::size_t>& terms, double left, Best& best) const;
  void add_grown(const SparseSum& sum, Best& best) const;
  // Into `gram`, of the other columns and the target: products of what is left of them without
  // their part along column k, the columns scaled to unit length again.
  void fill_without(std::size_t k, std::span<const std::size_t> others,
                    std::vector<double>& gram) const;
  double with_target(std::size_t i) const { return gram_[i * stride_ + columns_]; }

  std::vector<double> gram_;
  std::vector<char> once_;
  std::size_t columns_;
  std::size_t stride_;
};

}  // namespace tribench::relay
