// SPDX-License-Identifier: MIT
//
// A million random formulas; a share of them runs by day in agreement_test.cpp.
#include <gtest/gtest.h>

#include "foundation/random.hpp"
#include "tests/algorithms/expression/agreement.hpp"

namespace tribench {
namespace {

TEST(MillionFormulas, AgreeInEveryWayOfEvaluatingInDouble) {
  expect_agreement<double>(key_of("a million"), 1000000);
}

TEST(MillionFormulas, AgreeInEveryWayOfEvaluatingInFloat) {
  expect_agreement<float>(key_of("a million"), 200000);
}

}  // namespace
}  // namespace tribench
