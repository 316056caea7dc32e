// SPDX-License-Identifier: MIT
#include "tests/algorithms/expression/agreement.hpp"

#include <gtest/gtest.h>

#include "foundation/random.hpp"

namespace tribench {
namespace {

TEST(RandomFormulas, AgreeInEveryWayOfEvaluatingInDouble) {
  expect_agreement<double>(key_of("by day"), 20000);
}

TEST(RandomFormulas, AgreeInEveryWayOfEvaluatingInFloat) {
  expect_agreement<float>(key_of("by day"), 5000);
}

}  // namespace
}  // namespace tribench
