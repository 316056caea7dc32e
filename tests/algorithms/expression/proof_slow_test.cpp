// SPDX-License-Identifier: MIT
//
// The property tests in full: minutes.
#include <gtest/gtest.h>

#include "tests/algorithms/expression/containment.hpp"

namespace tribench {
namespace {

TEST(BoundsSlow, contain_every_sampled_value_over_100000_formulas_and_boxes) {
  testing::expect_containment("bounds slow", 100000);
}

TEST(SoundnessSlow, no_formula_of_100000_proved_free_is_ever_caught) {
  testing::expect_soundness(
      "soundness slow", {.formulas = 100000, .random_points = 10000, .adversarial_points = 10000});
}

}  // namespace
}  // namespace tribench
