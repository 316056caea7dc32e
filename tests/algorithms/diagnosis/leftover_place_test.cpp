// SPDX-License-Identifier: MIT
//
// Where something lives that no family of the library is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "tests/algorithms/diagnosis/half_sines.hpp"

namespace tribench::loop {
namespace {

// A cable chain pulls a carriage by the place alone. Smooth functions of the place and the speed
// together are smoother than those of the place by itself, and predict it better.
TEST(LeftoverPlace, IsOneInputWhereAnotherAddsNothing) {
  for (const std::uint64_t seed : {31U, 32U, 34U}) {
    Observations data = half_sines_over({.movements = 30, .rows = 200, .seed = seed}, [](double q) {
      return kHalfSinesNoise * (q + std::tanh(4 * (q - 0.2)));
    });
    std::ranges::find(data.signals, "q", &Signal::name)->unit = "m";
    const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, {});
    EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
    EXPECT_EQ(diagnosis.leftover.inputs, std::vector<std::string>{"position"}) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
