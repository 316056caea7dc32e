// SPDX-License-Identifier: MIT
//
// Ranges of the partial derivatives (Clarke's, at a kink) of every node of a formula by some of its
// inputs, carried forward beside the ranges of its values. Internal to the room.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/expression/natural_extension.hpp"

namespace tribench {

class IntervalGradient {
 public:
  // Of so many nodes by these inputs, from now on.
  void begin(std::size_t nodes, const std::vector<std::size_t>& inputs);
  // Of node i, from the ranges of the nodes up to it and their derivatives.
  void bound(const NaturalExtension& extension, std::size_t i,
             const NaturalExtension::Values& values);
  // A range an input.
  const Interval* of(std::size_t node) const { return ranges_.data() + node * inputs_.size(); }

 private:
  void bound_leaf(const Node& node, std::size_t i);
  void bound_power(const NaturalExtension& extension, std::size_t i,
                   const NaturalExtension::Values& values);
  void bound_arithmetic(const NaturalExtension& extension, std::size_t i,
                        const NaturalExtension::Values& values);
  Interval* at(std::size_t node) { return ranges_.data() + node * inputs_.size(); }

  std::vector<std::size_t> inputs_;
  std::vector<Interval> ranges_;  // node-major, one an input
};

}  // namespace tribench
