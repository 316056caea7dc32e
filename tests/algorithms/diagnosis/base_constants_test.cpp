// SPDX-License-Identifier: MIT
//
// A base whose constants the data do not tell: its fit leaves them anywhere.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "foundation/random.hpp"
#include "problems/reading/csv.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

constexpr double kRowStep = 0.02;

// Half sines one way and the other; Coulomb and viscous friction, and what grows with the time and
// with q^3.
Observations drifting_strokes(std::uint64_t seed) {
  RandomStream random(seed);
  std::string text = "movement,time_s,q,v,a,friction_torque_Nm\n";
  double begin = 0;
  for (int m = 0; m < 40; ++m) {
    const double s = m % 2 == 0 ? 1 : -1;
    const double w = random.uniform(0.7, 2.5);
    const double seconds = std::numbers::pi / w;
    for (double t = kRowStep; t < seconds; t += kRowStep) {
      const double q = -s * std::cos(w * t);
      const double v = s * w * std::sin(w * t);
      const double friction = s * (4 + 0.015 * (begin + t)) + 6 * v;
      text += fmt::format("{},{},{},{},{},{}\n", m, begin + t, q, v, s * w * w * std::cos(w * t),
                          friction + q * q * q + 0.25 * random.normal());
    }
    begin += seconds;
  }
  return observe(parse_csv(text, "strokes.csv").data);
}

// A curve that falls within one row, as a fit of one that is not there may end: nothing could be
// judged beside it, and nothing was named.
TEST(BaseConstants, ThatOneFoldAloneTellsHideNoEffect) {
  const BaseMaker base = [](const Observations& data) {
    const double there = std::abs(data.find("v")->values[data.rows() / 2]);
    return formula_base(data,
                        fmt::format("sgn_v*(4 + 0.5*exp(-abs(v/{:.17g})^50000)) + 6*v", there));
  };
  for (const std::uint64_t seed : {7U, 9U, 10U, 16U}) {
    const Diagnosis diagnosis = diagnose(drifting_strokes(seed), base, {});
    EXPECT_THAT(families(diagnosis), testing::UnorderedElementsAre("drift", "spring")) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
