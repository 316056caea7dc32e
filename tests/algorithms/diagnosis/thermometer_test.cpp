// SPDX-License-Identifier: MIT
//
// Friction that falls while the joint warms up, and a thermometer as drives have them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "foundation/random.hpp"
#include "problems/reading/csv.hpp"
#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

constexpr double kSlope = -0.15;  // N m a kelvin

double slope_of(const Diagnosis& diagnosis) {
  for (const ParameterFinding& p : diagnosis.effects.at(0).parameters) {
    if (p.name == "coulomb_slope") return p.value;
  }
  return 0;
}

// Half sines for 900 s, the joint is cold again half way. The noise of the torque lasts some rows.
Observations warming_up(std::uint64_t seed, const std::function<double(double)>& thermometer) {
  RandomStream random(seed);
  std::string text = "movement,time_s,q,v,temperature_degC,friction_torque_Nm\n";
  double noise = 0;
  for (int m = 0; m < 30; ++m) {
    const double w = random.uniform(0.4, 2.5);
    const double reach = random.uniform(0.7, 1.2);
    for (double t = 0.1; t < 25; t += 0.1) {
      const double time = 30 * m + t;
      const double warm = 22 + 12 * (1 - std::exp(-(m < 15 ? time : time - 450) / 150));
      const double v = reach * w * std::sin(w * t);
      const double s = v > 0 ? 1 : -1;
      noise = 0.8 * noise + 0.6 * random.normal();
      text += fmt::format("{},{},{},{},{},{}\n", m, time, -reach * std::cos(w * t), v,
                          thermometer(warm), s * (4 + kSlope * (warm - 22)) + 6 * v + 0.05 * noise);
    }
  }
  return observe(parse_csv(text, "warming_up.csv").data);
}

TEST(Thermometer, OfWholeDegreesTellsTheTemperature) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Observations data = warming_up(seed, [](double warm) { return std::round(warm); });
    const Diagnosis diagnosis = diagnose_most(data, {});
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << seed;
    ASSERT_THAT(families(diagnosis), ::testing::ElementsAre("temperature")) << seed;
    EXPECT_NEAR(slope_of(diagnosis), kSlope, 0.02 * -kSlope) << seed;
  }
}

TEST(Thermometer, ThatIsNoisyTellsTheTemperature) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    RandomStream random(seed);
    const Observations data =
        warming_up(seed, [&](double warm) { return warm + 0.5 * random.normal(); });
    const Diagnosis diagnosis = diagnose_most(data, {});
    EXPECT_EQ(diagnosis.verdict, Verdict::effects) << seed;
    ASSERT_THAT(families(diagnosis), ::testing::ElementsAre("temperature")) << seed;
    EXPECT_NEAR(slope_of(diagnosis), kSlope, 0.02 * -kSlope) << seed;
  }
}

}  // namespace
}  // namespace tribench::loop
