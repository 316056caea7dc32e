// SPDX-License-Identifier: MIT
//
// The property tests in full: minutes.
#include <gtest/gtest.h>

#include "tests/algorithms/expression/containment.hpp"

namespace tribench {
namespace {

TEST(BoundsSlow, ContainEverySampledValueOver100000FormulasAndBoxes) {
  testing::expect_containment("bounds slow", 100000);
}

TEST(SoundnessSlow, NoFormulaOf100000ProvedFreeIsEverCaught) {
  testing::expect_soundness(
      "soundness slow", {.formulas = 100000, .random_points = 10000, .adversarial_points = 10000});
}

}  // namespace
}  // namespace tribench
