// SPDX-License-Identifier: MIT
//
// Looks for witnesses of a singularity: points of a box at which a node of the formula is not
// finite, or neighbouring points between which a divisor changes its sign. What it returns has been
// confirmed with the evaluator; that it finds nothing means nothing.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/singularity.hpp"
#include "foundation/random.hpp"

namespace tribench {

// The node whose zeros, or whose leaving of its domain, make node `failed` fail.
std::size_t culprit_of(const Expression& formula, std::size_t failed);

class WitnessSearch {
 public:
  explicit WitnessSearch(const Expression& formula);

  // Starts on a new connected part of the box: remembered signs are forgotten.
  void enter(std::span<const Interval> cell);

  // Middle and corners (of the first kMaxCornerInputs inputs whose range is no point), and random
  // points of the box.
  static constexpr std::size_t kMaxCornerInputs = 4;
  std::optional<Witness> probe_corners(std::span<const Interval> box);
  std::optional<Witness> probe_random(std::span<const Interval> box, int count);
  // One point; also compares the divisors' signs with those seen before in this cell.
  std::optional<Witness> probe(std::span<const double> point);
  // From the middle of the box, goes to where node `failed` comes closest to failing (its divisor
  // to 0, the operand of its log or sqrt to negative, its value to overflow), one input at a time,
  // and looks at the doubles around.
  std::optional<Witness> descend(std::span<const Interval> box, std::size_t failed);

  // The smaller, the closer to failing node `failed` was at the point last probed.
  double distance(std::size_t failed) const;
  double distance_at(std::span<const double> point, std::size_t failed);

 private:
  struct Signs {
    std::vector<double> negative;
    std::vector<double> positive;
    int attempts = 0;
  };

  std::size_t trace(std::span<const double> point);  // fills values_; first node not finite
  std::optional<Witness> confirm(std::span<const double> point);
  std::optional<Witness> compare_signs(std::span<const double> point);
  void descend_axis(Interval side, std::size_t axis, std::size_t failed, std::vector<double>& at);
  std::optional<Witness> bisect(std::size_t node, std::vector<double> a, std::vector<double> b);
  std::optional<Witness> bisect_axis(std::size_t node, std::vector<double> a, double b,
                                     std::size_t axis);
  bool is_continuous_between(std::size_t node, const std::vector<double>& a,
                             const std::vector<double>& b);
  double computed(std::size_t node, std::span<const double> point);

  Expression formula_;
  Evaluator evaluator_;
  FormulaBounds bounds_;
  RandomStream random_;
  std::vector<std::size_t> columns_;  // that occur
  std::vector<std::size_t> zeros_;    // nodes whose zeros are poles: of divisors and logarithms
  std::vector<Signs> signs_;          // per entry of zeros_
  std::vector<double> values_;
  std::vector<double> point_;
  std::vector<Interval> cell_;
};

}  // namespace tribench
