// SPDX-License-Identifier: MIT
#include "harness/loop/determined_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "harness/loop/judged_diagnosis.hpp"

namespace tribench::loop {
namespace {

constexpr int kBackwards = 3;
constexpr double kNoise_nm = 0.1;

// Strokes forwards, and one backwards.
Observations one_stroke_backwards() {
  RandomStream random(11);
  Dataset data;
  data.channels = {{"v", "rad/s", Role::velocity, {}}, {"tau", "N m", Role::friction_torque, {}}};
  for (int m = 0; m < 8; ++m) {
    data.movement_names.push_back("m" + std::to_string(m));
    for (int i = 1; i < 100; ++i) {
      const double speed = (0.4 + 0.1 * m) * std::sin(0.0314 * i);
      const double v = m == kBackwards ? -speed : speed;
      data.channels[0].values.push_back(v);
      data.channels[1].values.push_back((v > 0 ? 5 : -5) + 3 * v + kNoise_nm * random.normal());
      data.movement.push_back(m);
    }
  }
  return observe(data);
}

TEST(DeterminedRows, AreNotThoseOfADirectionThatNoOtherMovementHas) {
  const Observations data = one_stroke_backwards();
  LoopModel model;
  model.base = coulomb_viscous_base(data);
  model.coefficients.setZero(static_cast<Eigen::Index>(model.base.linear_terms.size()));
  for (const int left_out : {kBackwards, kBackwards + 1}) {
    std::vector<char> train(data.rows());
    for (std::size_t i = 0; i < data.rows(); ++i) train[i] = data.movement[i] != left_out ? 1 : 0;
    const std::vector<char> determined = determined_rows(model, data, train, 1);
    for (std::size_t i = 0; i < data.rows(); ++i) {
      if (data.movement[i] != left_out) continue;
      ASSERT_EQ(determined[i], left_out == kBackwards ? 0 : 1) << i;
    }
  }
}

// What models without it say of it is no error of the model.
TEST(DeterminedRows, AloneAreJudgedAndTheOthersAreNamed) {
  const JudgedDiagnosis diagnosis =
      diagnose_and_judge(one_stroke_backwards(), coulomb_viscous_base, {});
  EXPECT_EQ(diagnosis.error.test_movements, 7U);
  EXPECT_LT(diagnosis.error.mae_before, kNoise_nm);
  EXPECT_THAT(diagnosis.notes,
              ::testing::Contains(::testing::StartsWith("99 rows of 1 movements ('m3') are not")));
}

}  // namespace
}  // namespace tribench::loop
