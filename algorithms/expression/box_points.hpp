// SPDX-License-Identifier: MIT
//
// A formula at the centre of a box and, where few inputs vary, at its corners: what the mean value
// theorem and monotone nodes sharpen ranges with. Internal to the room.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/expression/natural_extension.hpp"

namespace tribench {

class BoxPoints {
 public:
  // active: the inputs whose range is not a point.
  void evaluate(const NaturalExtension& extension, std::span<const Interval> box,
                const std::vector<std::size_t>& active);

  bool has_centre(std::size_t node) const { return centre_failed_ > node; }
  const Interval& centre(std::size_t node) const { return centre_[node].range; }
  const Interval& centre_of_input(std::size_t input) const { return centre_box_[input]; }

  // Narrows the range of a node to that between the corners where its derivatives (one an active
  // input) have the same sign everywhere; false where they have not, or a corner is not finite.
  bool narrow_between_corners(std::size_t node, const Interval* derivatives, Interval& range) const;

 private:
  static constexpr std::size_t kMaxCornerInputs = 2;

  std::size_t active_ = 0;
  std::vector<Interval> centre_box_;
  std::vector<Interval> corner_box_;
  NaturalExtension::Values centre_;
  std::size_t centre_failed_ = 0;
  std::vector<NaturalExtension::Values> corners_;  // bit j: active input j at its upper end
  std::vector<std::size_t> corners_failed_;
};

}  // namespace tribench
