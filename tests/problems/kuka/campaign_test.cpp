// SPDX-License-Identifier: MIT
#include "problems/kuka/campaign.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace tribench::kuka {
namespace {

TEST(Campaign, ARunsEverySettingOnce) {
  const std::vector<Setting> order = campaign_order(make_joint(2, 1), 1);
  std::set<std::pair<int, int>> seen;
  for (const Setting& setting : order) seen.insert({setting.speed, setting.direction});
  EXPECT_EQ(order.size(), 90U);
  EXPECT_EQ(seen.size(), 90U);
}

TEST(Campaign, RawRowsObeyTheLawUpToRippleAndNoise) {
  const Joint joint = make_joint(4, 3);
  const KnownDataset raw = make_a_raw(joint, 3, 100);
  ASSERT_EQ(raw.data.rows(), 9000U);
  const auto& q = raw.data.at("q").values;
  const auto& v = raw.data.at("qd").values;
  const auto& g = raw.data.at("g").values;
  const auto& y = raw.data.at("tau_f").values;
  const auto& t = raw.data.at("time_s").values;
  double squares = 0;
  for (std::size_t r = 0; r < raw.data.rows(); ++r) {
    EXPECT_LE(std::abs(q[r]), kStrokeEnd_rad + 1e-9);
    EXPECT_NEAR(g[r], 12.2 * std::sin(q[r]), 1e-12);
    EXPECT_NEAR(raw.truth[r], joint.law.at(v[r], g[r]), 1e-12);
    const double noise = y[r] - raw.truth[r] - ripple_at(joint.ripple, q[r]);
    squares += noise * noise;
    if (r > 0) {
      EXPECT_GE(t[r], t[r - 1]);
    }
  }
  EXPECT_NEAR(std::sqrt(squares / 9000), std::hypot(0.60, 0.078), 0.02);
}

TEST(Campaign, SeedsChangeTheDataAndTheSameSeedDoesNot) {
  const auto values = [](std::uint64_t seed) {
    return make_a_averaged(make_joint(2, seed), seed).data.at("tau_f").values;
  };
  EXPECT_EQ(values(5), values(5));
  EXPECT_NE(values(5), values(6));
}

TEST(Campaign, BKeepsTheStrokeAndAddsUpItsTorques) {
  const Joint joint = make_joint(2, 1);
  const KnownDataset b = make_b(joint, 1, kPayload_kg, 3, 500);
  ASSERT_EQ(b.data.rows(), 1500U);
  const auto& g = b.data.at("g").values;
  const auto& arm = b.data.at("g_arm").values;
  const auto& external = b.data.at("tau_ext").values;
  const auto& motor = b.data.at("tau_m").values;
  const auto& friction = b.data.at("tau_f").values;
  double covariance = 0;
  for (std::size_t r = 0; r < b.data.rows(); ++r) {
    EXPECT_LE(std::abs(b.data.at("q").values[r]), kStrokeEnd_rad + 1e-9);
    EXPECT_NEAR(g[r], arm[r] + external[r], 1e-12);
    EXPECT_NEAR(motor[r], g[r] + friction[r], 1e-12);
    EXPECT_NEAR(external[r] / arm[r], 9.81 * 1.5 * 0.868 / 42.4, 1e-9);
    covariance += friction[r] * b.data.at("qd").values[r];
  }
  EXPECT_GT(covariance, 0);  // friction is positive with velocity
}

}  // namespace
}  // namespace tribench::kuka
