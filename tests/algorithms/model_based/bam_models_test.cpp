// SPDX-License-Identifier: MIT
//
// BAM's models against torques that are solved for by iteration, row by row, as a simulator would:
// the equations of the paper, not the closed form that the methods fit.
#include "algorithms/model_based/bam_models.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "problems/data_problem.hpp"
#include "tests/support/fit.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using testing::mean_absolute_error;
using testing::run_fit;
using testing::Training;

struct Servo {
  double viscous = 0.3;
  double coulomb = 0.4;
  double stribeck = 0;
  double motor = 0;
  double external = 0;
  double motor_stribeck = 0;
  double external_stribeck = 0;
  double motor_quadratic = 0;
  double external_quadratic = 0;

  // The friction budget at a motor torque; `held` is minus the paper's external torque.
  double budget(double v, double torque, double held) const {
    const double e = std::exp(-std::pow(std::abs(v / 0.25), 1.5));
    double budget = viscous * std::abs(v) + coulomb + e * stribeck;
    budget += std::abs(external * -held - motor * torque);
    budget += e * std::abs(external_stribeck * -held - motor_stribeck * torque);
    if (-held * torque < 0) {
      budget += e * (std::abs(held) < std::abs(torque) ? external_quadratic * held * held
                                                       : motor_quadratic * torque * torque);
    }
    return budget;
  }
};

constexpr double kNoise = 0.01;

Dataset measure(const Servo& servo) {
  Dataset data;
  data.name = "servo";
  data.movement_names = {"one"};
  data.channels = {{"v", "rad/s", Role::velocity, {}},
                   {"a", "rad/s^2", Role::acceleration, {}},
                   {"g", "N m", Role::gravity_torque, {}},
                   {"tau", "N m", Role::motor_torque, {}}};
  RandomStream random(11);
  for (int r = 0; r < 3000; ++r) {
    const double v = 4 * (2 * random.uniform() - 1) * random.uniform();
    const double a = 6 * random.normal();
    const double g = 2 * (2 * random.uniform() - 1);
    double torque = 0.05 * a + g;
    for (int k = 0; k < 200; ++k) {
      torque = 0.05 * a + g + (v > 0 ? 1 : -1) * servo.budget(v, torque, g);
    }
    const std::vector<double> row = {v, a, g, torque + kNoise * random.normal()};
    for (std::size_t j = 0; j < row.size(); ++j) data.channels[j].values.push_back(row[j]);
    data.movement.push_back(0);
  }
  return data;
}

double error_of(const Dataset& data, const std::string& method) {
  const std::vector<std::string> inputs = {"v", "a", "g"};
  const Problem problem = make_data_problem(data, nullptr, "tau", inputs);
  const Training training(problem);
  const FitResult result = run_fit(training.data(), method);
  return mean_absolute_error(result.front.at(0), training.data(), training.table->target);
}

constexpr double kNoiseError = 0.8 * kNoise;  // E |n| of a normal number

TEST(BamModels, CoulombAndViscousIsExact) {
  EXPECT_LT(error_of(measure({}), "bam_m1"), 1.05 * kNoiseError);
}

TEST(BamModels, StribeckIsFound) {
  const Dataset data = measure({.stribeck = 0.3});
  EXPECT_LT(error_of(data, "bam_m2"), 1.05 * kNoiseError);
  EXPECT_GT(error_of(data, "bam_m1"), 1.5 * kNoiseError);
}

TEST(BamModels, FrictionFromLoadIsFoundThoughItActsOnItself) {
  const Dataset data = measure({.motor = 0.25, .external = 0.25});
  EXPECT_LT(error_of(data, "bam_m3"), 1.05 * kNoiseError);
  EXPECT_GT(error_of(data, "bam_m2"), 5 * kNoiseError);
}

TEST(BamModels, LoadAndStribeckTogether) {
  const Dataset data = measure({.stribeck = 0.2,
                                .motor = 0.1,
                                .external = 0.1,
                                .motor_stribeck = 0.2,
                                .external_stribeck = 0.2});
  EXPECT_LT(error_of(data, "bam_m4"), 1.05 * kNoiseError);
  EXPECT_GT(error_of(data, "bam_m3"), 2 * kNoiseError);
}

TEST(BamModels, DirectionsOfLoadDiffer) {
  const Dataset data = measure({.stribeck = 0.2,
                                .motor = 0.27,
                                .external = 0.05,
                                .motor_stribeck = 0.02,
                                .external_stribeck = 0.08});
  EXPECT_LT(error_of(data, "bam_m5"), 1.3 * kNoiseError);
  EXPECT_GT(error_of(data, "bam_m4"), 3 * kNoiseError);
}

TEST(BamModels, TheWeakerSideCountsByItsSquare) {
  const Dataset data = measure({.stribeck = 0.2,
                                .motor = 0.15,
                                .external = 0.05,
                                .motor_stribeck = 0.02,
                                .external_stribeck = 0.08,
                                .motor_quadratic = 0.15,
                                .external_quadratic = 0.3});
  const double six = error_of(data, "bam_m6");
  EXPECT_LT(six, 2 * kNoiseError);
  EXPECT_GT(error_of(data, "bam_m5"), 1.5 * six);
}

TEST(BamModels, SayWhatIsMissing) {
  Dataset data = measure({});
  data.channels[2].role = Role::none;
  const std::vector<std::string> inputs = {"v", "a", "g"};
  const Problem problem = make_data_problem(data, nullptr, "tau", inputs);
  const Training training(problem);
  EXPECT_EQ(run_fit(training.data(), "bam_m2").reason, StopReason::converged);
  const FitResult refused = run_fit(training.data(), "bam_m3");
  EXPECT_EQ(refused.reason, StopReason::unsupported);
  EXPECT_THAT(refused.note, HasSubstr("gravity_torque"));
}

}  // namespace
}  // namespace tribench
