// SPDX-License-Identifier: MIT
//
// A base whose constants the data do not tell: its fit leaves them anywhere.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "tests/algorithms/diagnosis/half_sines.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

// A curve that falls within one row, as a fit of one that is not there may end: nothing could be
// judged beside it, and nothing was named.
TEST(BaseConstants, ThatOneFoldAloneTellsHideNoEffect) {
  const BaseMaker base = [](const Observations& data) {
    const double there = std::abs(data.find("v")->values[data.rows() / 2]);
    return formula_base(data,
                        fmt::format("sgn_v*(4 + 0.5*exp(-abs(v/{:.17g})^50000)) + 6*v", there));
  };
  for (const std::uint64_t seed : {6U, 8U, 10U, 13U, 18U}) {
    const Observations data = half_sines_over({40, 80, seed}, [](double q) { return q * q * q; });
    EXPECT_THAT(families(diagnose(data, base, {})), testing::ElementsAre("spring")) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
