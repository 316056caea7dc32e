// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/algorithms/expression/containment.hpp"

namespace tribench {
namespace {

TEST(Soundness, no_formula_proved_free_is_ever_caught) {
  testing::expect_soundness("soundness",
                            {.formulas = 6000, .random_points = 100, .adversarial_points = 200});
}

}  // namespace
}  // namespace tribench
