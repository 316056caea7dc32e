// SPDX-License-Identifier: MIT
//
// What is left over and significant, and worth nothing. That larger ones are told:
// diagnosis_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "tests/algorithms/diagnosis/half_sines.hpp"

namespace tribench::loop {
namespace {

// A place where the torque dips, as no known effect does: by half the noise, over a twentieth of
// the way.
Diagnosis diagnose_dip() {
  const auto dip = [](double q) {
    const double x = (q - 0.2) / 0.06;
    return -0.45 * kHalfSinesNoise * std::exp(-x * x);
  };
  return diagnose(half_sines_over({.movements = 24, .rows = 500, .seed = 7}, dip),
                  coulomb_viscous_base, {});
}

TEST(SlightLeftover, IsNotToldHoweverManyRowsMakeItSignificant) {
  const Diagnosis diagnosis = diagnose_dip();
  EXPECT_EQ(diagnosis.verdict, Verdict::none);
  EXPECT_TRUE(diagnosis.leftover.inputs.empty());
  EXPECT_LT(diagnosis.leftover.p, 0.002);
}

}  // namespace
}  // namespace tribench::loop
