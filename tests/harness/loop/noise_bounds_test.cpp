// SPDX-License-Identifier: MIT
#include "harness/loop/noise_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "harness/loop/judged_diagnosis.hpp"
#include "problems/kuka/planted.hpp"

namespace tribench::loop {
namespace {

// Movements at constant speed with independent normal noise; `unexplained` is added to the
// friction.
template <typename Unexplained>
Observations with_noise(double noise, Unexplained unexplained) {
  RandomStream random(5);
  Dataset data;
  data.channels = {{"v", "rad/s", Role::velocity, {}},
                   {"q", "rad", Role::position, {}},
                   {"tau", "N m", Role::friction_torque, {}}};
  for (int m = 0; m < 60; ++m) {
    data.movement_names.push_back("m" + std::to_string(m));
    const double v = (m % 2 == 0 ? 1 : -1) * (0.1 + 0.01 * m);
    for (int i = 0; i < 60; ++i) {
      const double q = -1.5 + 0.05 * i;
      data.channels[0].values.push_back(v);
      data.channels[1].values.push_back(q);
      data.channels[2].values.push_back((v > 0 ? 5 : -5) + 3 * v + unexplained(q) +
                                        noise * random.normal());
      data.movement.push_back(m);
    }
  }
  return observe(data);
}

JudgedDiagnosis bounded(const Observations& data, const DiagnosisOptions& options) {
  return diagnose_and_judge(data, coulomb_viscous_base, options, {.bounds = true});
}

double mean_magnitude(double sd) { return sd * std::sqrt(2 / std::numbers::pi); }

TEST(NoiseBounds, BoundsIndependentNoiseFromBothSidesWithinAFewPerCent) {
  const Observations data = with_noise(0.3, [](double) { return 0.0; });
  const JudgedDiagnosis diagnosis = bounded(data, {});
  EXPECT_NEAR(diagnosis.error.ceiling, mean_magnitude(0.3), 0.06 * mean_magnitude(0.3));
  EXPECT_NEAR(diagnosis.error.attainable, mean_magnitude(0.3), 0.06 * mean_magnitude(0.3));
  EXPECT_LE(diagnosis.error.ceiling, diagnosis.error.attainable);
}

// A bump that no family has: the loop closes nothing of it, a smoother would.
TEST(NoiseBounds, SaysWhatTheLibraryLeavesUnclosed) {
  const Observations data =
      with_noise(0.2, [](double q) { return 1.5 * std::exp(-std::pow((q - 0.4) / 0.12, 2)); });
  DiagnosisOptions options;
  options.families = {"stribeck", "nonlinear_viscous"};
  const JudgedDiagnosis diagnosis = bounded(data, options);
  EXPECT_EQ(diagnosis.verdict, Verdict::unknown);
  EXPECT_NEAR(diagnosis.error.attainable, mean_magnitude(0.2), 0.15 * mean_magnitude(0.2));
  EXPECT_LT(diagnosis.error.closed_fraction_high, 0.1);
  EXPECT_LE(diagnosis.error.closed_low, diagnosis.error.closed_fraction);
  EXPECT_GE(diagnosis.error.closed_high, diagnosis.error.closed_fraction);
}

TEST(NoiseBounds, ClosesTheGapOfAPlantedEffectAndBracketsItsNoise) {
  const Observations data =
      observe(kuka::make_planted({.effects = {{"load_coulomb", 2.0}}}, 2).data);
  DiagnosisOptions options;
  options.gear_ratios = {160};
  options.physical_vetoes = false;
  const JudgedDiagnosis diagnosis = bounded(data, options);
  EXPECT_LE(diagnosis.error.ceiling, diagnosis.error.attainable);
  EXPECT_LE(diagnosis.error.attainable, diagnosis.error.mae_after);
  EXPECT_GT(diagnosis.error.closed_fraction_high, 0.97);
}

TEST(NoiseBounds, SaysWhyItIsNotThere) {
  const Observations data = with_noise(0.3, [](double) { return 0.0; });
  ErrorFinding error;
  error.mae_before = error.mae_after = 1;
  const Observations few = data.select([&] {
    std::vector<char> keep(data.rows(), 0);
    std::fill_n(keep.begin(), 20, 1);
    return keep;
  }());
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(20);
  bound_noise(error, few, ones, ones, ones, few.movement, RandomStream(1));
  EXPECT_TRUE(std::isnan(error.ceiling));
  EXPECT_FALSE(error.ceiling_note.empty());
}

}  // namespace
}  // namespace tribench::loop
