// SPDX-License-Identifier: MIT
#include "problems/kuka/trials.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "problems/catalogue.hpp"
#include "problems/kuka/entries.hpp"

namespace tribench::kuka {
namespace {

TEST(ExternalTorqueTrial, IsWhatTheMotorGivesBeyondTheArmsGravity) {
  const Joint joint = make_joint(2, 3);
  const ExternalTorqueTrial trial = make_external_torque_trial(joint, 3);
  const Problem tested = Catalogue().find("B/j2/load").make(3);
  ASSERT_EQ(trial.rows.rows(), tested.test.rows());
  double error = 0;
  for (std::size_t r = 0; r < trial.rows.rows(); ++r) {
    // The same instants as the problem's test: same velocity, gravity without the payload.
    ASSERT_EQ(trial.rows.columns[0][r], tested.test.columns[0][r]);
    EXPECT_NEAR(trial.rows.columns[2][r] + trial.rows.truth[r], tested.test.columns[2][r], 1e-9);
    EXPECT_NEAR(trial.rows.target[r], tested.test.target[r] + trial.rows.truth[r], 1e-9);
    error += std::abs(trial.rows.target[r] - tested.test.truth[r] - trial.rows.truth[r]);
  }
  // With the true friction only noise is left.
  EXPECT_LT(error / static_cast<double>(trial.rows.rows()), 0.75);
}

TEST(ExternalTorqueTrial, MarksRowsBeyondWhatTheAdaptationHasSeen) {
  const Joint joint = make_joint(4, 1);
  const ExternalTorqueTrial trial = make_external_torque_trial(joint, 1);
  for (std::size_t r = 0; r < trial.rows.rows(); ++r) {
    EXPECT_EQ(trial.outside_fitted_range[r] != 0,
              std::abs(trial.rows.columns[2][r]) > trial.largest_fitted_gravity_nm);
  }
  EXPECT_GT(trial.largest_fitted_gravity_nm, 5);
}

TEST(VelocityProfile, IsOnePeriodOfASineAlongTheLaw) {
  const Joint joint = make_joint(2, 1);
  const VelocityProfile profile = make_velocity_profile(joint);
  ASSERT_EQ(profile.time_s.size(), 1001U);
  EXPECT_NEAR(profile.rows.columns[0][250], 0.6, 1e-12);
  EXPECT_NEAR(profile.rows.columns[0][750], -0.6, 1e-12);
  EXPECT_EQ(profile.rows.columns[1][750], -1);
  for (std::size_t r = 0; r < profile.time_s.size(); ++r) {
    EXPECT_EQ(profile.rows.target[r],
              joint.law.at(profile.rows.columns[0][r], profile.rows.columns[2][r]));
  }
}

}  // namespace
}  // namespace tribench::kuka
