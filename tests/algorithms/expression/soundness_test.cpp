// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/algorithms/expression/containment.hpp"

namespace tribench {
namespace {

TEST(Soundness, NoFormulaProvedFreeIsEverCaught) {
  testing::expect_soundness("soundness",
                            {.formulas = 6000, .random_points = 100, .adversarial_points = 200});
}

}  // namespace
}  // namespace tribench
