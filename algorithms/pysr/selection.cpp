// SPDX-License-Identifier: MIT
#include "algorithms/pysr/selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/elementary.hpp"

namespace tribench::pysr {
namespace {

constexpr double kBestWithin = 1.5;  // PySR, pysr/sr.py

}  // namespace

std::vector<double> front_scores(std::span<const FrontPoint> front) {
  std::vector<double> scores(front.size(), 0.0);
  for (std::size_t i = 1; i < front.size(); ++i) {
    const double steps = front[i].size - front[i - 1].size;
    if (!(steps > 0) || !(front[i - 1].loss > 0)) continue;
    const double fall = elementary::log(front[i - 1].loss) - elementary::log(front[i].loss);
    scores[i] = std::max(0.0, fall / steps);
  }
  return scores;
}

std::size_t select(std::span<const FrontPoint> front, Selection rule) {
  if (front.empty()) return 0;
  const auto place = [&](auto found) { return static_cast<std::size_t>(found - front.begin()); };
  const auto most_accurate = std::ranges::min_element(front, {}, &FrontPoint::loss);
  if (rule == Selection::accuracy) return place(most_accurate);
  if (rule == Selection::posterior) {
    return place(std::ranges::min_element(front, {}, &FrontPoint::distance));
  }
  if (rule == Selection::evidence) {
    return place(std::ranges::min_element(front, {}, &FrontPoint::evidence_against));
  }
  if (rule == Selection::mdl) {
    return place(std::ranges::min_element(front, {}, &FrontPoint::description_length));
  }
  const double limit = rule == Selection::best ? kBestWithin * most_accurate->loss
                                               : std::numeric_limits<double>::infinity();
  const std::vector<double> scores = front_scores(front);
  std::size_t best = place(most_accurate);
  bool found = false;
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (front[i].loss > limit || (found && scores[i] <= scores[best])) continue;
    best = i;
    found = true;
  }
  return best;
}

}  // namespace tribench::pysr
