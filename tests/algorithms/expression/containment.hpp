// SPDX-License-Identifier: MIT
//
// The property tests of bounds and proofs, with the number of trials as a parameter: a small one in
// the everyday suite, the full one in the slow suite.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/interval.hpp"
#include "foundation/random.hpp"

namespace tribench::testing {

using Box = std::vector<Interval>;

// Sides from points to 8 wide, often ending at whole numbers.
Box random_box(RandomStream& random, std::size_t inputs);

// Points of a box, corners first, as columns: [j][i] is input j of point i.
inline constexpr std::size_t kSamples = 48;
std::vector<std::vector<double>> sample_box(RandomStream& random, const Box& box);

// How many of the formula's values at these points lie outside the bounds.
int count_escapes(const Expression& formula, const std::vector<std::vector<double>>& columns,
                  const Interval& bounds);

// Random formulas over random boxes: fails where a value of a node escapes its bounds.
void expect_containment(std::string_view key, int trials);

struct SoundnessTrials {
  int formulas = 0;
  int random_points = 0;
  int adversarial_points = 0;
};
// Random formulas with divisions and domains: fails where a formula proved free, or one of its
// subformulas, is not finite at a random or an adversarial point, or where a witness is none.
void expect_soundness(std::string_view key, const SoundnessTrials& trials);

}  // namespace tribench::testing
