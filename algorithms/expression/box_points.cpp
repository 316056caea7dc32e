// SPDX-License-Identifier: MIT
#include "algorithms/expression/box_points.hpp"

namespace tribench {

void BoxPoints::evaluate(const NaturalExtension& extension, std::span<const Interval> box,
                         const std::vector<std::size_t>& active) {
  active_ = active.size();
  centre_box_.assign(box.begin(), box.end());
  for (const std::size_t input : active) {
    centre_box_[input] = Interval::point(midpoint(box[input]));
  }
  centre_.resize(extension.formula().size());
  centre_failed_ = extension.pass(centre_box_, centre_);
  const std::size_t corners = active_ <= kMaxCornerInputs ? 1UL << active_ : 0;
  if (corners_.size() < corners) {
    corners_.resize(corners, NaturalExtension::Values(extension.formula().size()));
  }
  corners_failed_.assign(corners, 0);
  corner_box_ = centre_box_;
  for (std::size_t c = 0; c < corners; ++c) {
    for (std::size_t j = 0; j < active_; ++j) {
      const Interval& range = box[active[j]];
      corner_box_[active[j]] = Interval::point(((c >> j) & 1) != 0 ? range.high : range.low);
    }
    corners_failed_[c] = extension.pass(corner_box_, corners_[c]);
  }
}

bool BoxPoints::narrow_between_corners(std::size_t node, const Interval* derivatives,
                                       Interval& range) const {
  if (active_ > kMaxCornerInputs) return false;
  std::size_t low_corner = 0;
  for (std::size_t j = 0; j < active_; ++j) {
    if (derivatives[j].low < 0 && derivatives[j].high > 0) return false;
    if (derivatives[j].high <= 0) low_corner |= 1UL << j;
  }
  const std::size_t high_corner = ((1UL << active_) - 1) ^ low_corner;
  if (corners_failed_[low_corner] <= node || corners_failed_[high_corner] <= node) return false;
  range = intersect(range,
                    {corners_[low_corner][node].range.low, corners_[high_corner][node].range.high});
  return true;
}

}  // namespace tribench
