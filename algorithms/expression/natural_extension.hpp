// SPDX-License-Identifier: MIT
//
// A formula's natural interval extension, node by node: each from its children's ranges, knowing
// where both are the same formula (x - x, x x, x / x). Internal to the room.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/interval.hpp"

namespace tribench {

class NaturalExtension {
 public:
  using Values = std::vector<DecoratedInterval>;

  explicit NaturalExtension(const Expression& formula);

  const Expression& formula() const { return formula_; }
  // Of a binary node: whether its operands are the same formula.
  bool has_same_operands(std::size_t i) const { return same_operands_[i]; }

  // Node i from its children's bounds in `values`; box[j] is the range of variable j.
  DecoratedInterval extend(std::size_t i, std::span<const Interval> box,
                           const Values& values) const;
  // Fills `values` (as long as the tape) up to the first node that may not be finite, whose place
  // it returns; the tape's size where all are.
  std::size_t pass(std::span<const Interval> box, Values& values) const;

 private:
  Expression formula_;
  std::vector<bool> same_operands_;
};

}  // namespace tribench
