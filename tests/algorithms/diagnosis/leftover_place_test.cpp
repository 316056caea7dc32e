// SPDX-License-Identifier: MIT
//
// Where something lives that no family of the library is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "problems/joint_simulation/simulated_campaign.hpp"
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

// Grease that stands still is stiff for the first moments of every movement.
TEST(LeftoverPlace, IsTheTimeSinceTheStartWhereFrictionFadesAfterARest) {
  Observations data = observe(
      simulation::simulate({"", 1, simulation::NoiseKind::gaussian, simulation::Design::mixed}, 51)
          .data);
  EXPECT_EQ(diagnose(data, coulomb_viscous_base, {}).verdict, Verdict::none);
  const std::vector<double>& since = data.find(Signal::kSinceStart)->values;
  const std::vector<double>& sign = data.find("sgn_v")->values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    data.target[i] += sign[i] * std::exp(-since[i] / 0.5);
  }
  const Diagnosis diagnosis = diagnose(data, coulomb_viscous_base, {});
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_EQ(diagnosis.leftover.inputs, std::vector<std::string>{"time_since_start"});
}

}  // namespace
}  // namespace tribench::loop
