// SPDX-License-Identifier: MIT
#include "algorithms/inference/cross_validation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "foundation/pivoted_qr.hpp"

namespace tribench::loop {
namespace {

// Ten movements of 20 rows, a constant and a column that only the first movement excites.
struct Case {
  Clusters clusters;
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  Noise noise;
};

Case make_case() {
  std::vector<int> movement(200);
  for (std::size_t i = 0; i < movement.size(); ++i) movement[i] = static_cast<int>(i / 20);
  Case c;
  c.clusters = make_clusters(movement, 1);
  c.x = Eigen::MatrixXd::Ones(200, 2);
  c.x.col(1).tail(180).setZero();
  RandomStream random(2);
  c.y = Eigen::VectorXd::NullaryExpr(200, [&] { return random.normal(); });
  c.noise.within_sd = 1;
  return c;
}

TEST(CrossValidation, WhatOneFoldAloneExcitesPredictsNothingThere) {
  const Case c = make_case();
  const Eigen::VectorXd losses = held_out_losses(c.x, c.y, c.clusters, c.noise);
  EXPECT_TRUE(std::isnan(losses[0]));
}

TEST(CrossValidation, WhatTheOthersHaveOfAColumnMustBeMoreThanRounding) {
  Case c = make_case();
  c.x.col(1).tail(180).setConstant(1e-8);
  EXPECT_TRUE(std::isnan(held_out_losses(c.x, c.y, c.clusters, c.noise)[0]));
  const auto with_share = [&](double share) {  // of the column's squares, that the others have
    c.x.col(1).tail(180).setConstant(std::sqrt(share * 20 / 180));
    return held_out_losses(c.x, c.y, c.clusters, c.noise)[0];
  };
  EXPECT_TRUE(std::isnan(with_share(0.8e-12)));
  EXPECT_TRUE(std::isfinite(with_share(1.3e-12)));
}

TEST(CrossValidation, APenalisedColumnHasNoWeightThere) {
  const Case c = make_case();
  const Eigen::VectorXd with = held_out_losses(c.x, c.y, c.clusters, c.noise, 1, 0.02);
  const Eigen::VectorXd without = held_out_losses(c.x.leftCols(1), c.y, c.clusters, c.noise);
  EXPECT_TRUE(with.allFinite());
  EXPECT_NEAR(with[0], without[0], 1e-6);
}

TEST(CrossValidation, AColumnOfZerosIsHarmless) {
  Case c = make_case();
  c.x.col(1).setZero();
  const Eigen::VectorXd with = held_out_losses(c.x, c.y, c.clusters, c.noise);
  const Eigen::VectorXd without = held_out_losses(c.x.leftCols(1), c.y, c.clusters, c.noise);
  EXPECT_LT((with - without).cwiseAbs().maxCoeff(), 1e-6);
}

// Each movement's mean is predicted from the others': with ten the loss is 100/81 of the variance.
TEST(CrossValidation, LossesAreThoseOfTheFitToTheOtherFolds) {
  Case c = make_case();
  for (Eigen::Index i = 0; i < 200; ++i) c.y[i] = i < 20 ? 10 : 1;
  c.noise.within_sd = 3;
  const Eigen::VectorXd losses = held_out_losses(c.x.leftCols(1), c.y, c.clusters, c.noise);
  EXPECT_NEAR(losses[0], 20 * 81 / (2 * 9.0), 1e-6);  // the others' mean is 1
  EXPECT_NEAR(losses[1], 20 / (2 * 9.0), 1e-6);       // theirs is 2
}

// Against the errors themselves, row by row, of least squares on the other folds.
TEST(CrossValidation, ColumnsBesideAModelCountAsIfTheyWereItsOwn) {
  Case c = make_case();
  RandomStream random(3);
  const Eigen::MatrixXd all =
      Eigen::MatrixXd::NullaryExpr(200, 4, [&] { return random.normal() + 1; });
  const Eigen::MatrixXd own = all.leftCols(2);
  const StretchGrams grams =
      with_columns(stretch_grams(own, c.y, c.clusters), own, c.y, all.rightCols(2), c.clusters);
  const Eigen::VectorXd losses = held_out_losses(grams, c.clusters, c.noise);
  for (Eigen::Index m = 0; m < 10; ++m) {
    Eigen::MatrixXd others = all;
    Eigen::VectorXd target = c.y;
    others.middleRows(20 * m, 20).setZero();
    target.segment(20 * m, 20).setZero();
    const Eigen::VectorXd b = PivotedQr(others).solve(target);
    const double squares = (c.y.segment(20 * m, 20) - all.middleRows(20 * m, 20) * b).squaredNorm();
    EXPECT_NEAR(losses[m], squares / c.noise.unit(), 1e-6) << m;
  }
}

TEST(CrossValidation, AModelWithoutColumnsLeavesTheTargetAsItIs) {
  const Case c = make_case();
  const Eigen::VectorXd losses = held_out_losses(Eigen::MatrixXd(200, 0), c.y, c.clusters, c.noise);
  for (Eigen::Index m = 0; m < 10; ++m) {
    EXPECT_DOUBLE_EQ(losses[m], c.y.segment(20 * m, 20).squaredNorm() / c.noise.unit()) << m;
  }
}

TEST(PairedGain, IsASumWithItsStandardError) {
  const Gain gain = paired_gain(Eigen::Vector2d(5, 8), Eigen::Vector2d(4, 5));
  EXPECT_DOUBLE_EQ(gain.nats, 4);
  EXPECT_DOUBLE_EQ(gain.error, 2);
}

// Two movements gain hundreds, which makes the error as large as the gain; the others gain, too.
TEST(PairedGain, IsSteadyWhereManyGainWhateverAFewDo) {
  Eigen::VectorXd gains = Eigen::VectorXd::Constant(40, 2);
  gains[0] = 600;
  gains[20] = 500;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(40);
  const Gain many = paired_gain(gains, none);
  EXPECT_LT(many.nats, 2 * many.error);
  EXPECT_GT(many.bounded_z, 6);
  gains = gains.cwiseProduct((gains.array() < 100).select(none.array(), 1).matrix());
  EXPECT_LT(paired_gain(gains, none).bounded_z, 2);
  EXPECT_LT(paired_gain(none, gains).bounded_z, 0);
  EXPECT_GT(paired_gain(Eigen::VectorXd::Constant(40, 50), none).bounded_z, 1e9);
}

TEST(PairedGain, OfOneStretchHasNoErrorToKnow) {
  const Gain gain = paired_gain(Eigen::VectorXd::Constant(1, 3.5), Eigen::VectorXd::Constant(1, 2));
  EXPECT_EQ(gain.nats, 1.5);
  EXPECT_EQ(gain.error, 0);
  EXPECT_EQ(gain.bounded_z, 0);
}

}  // namespace
}  // namespace tribench::loop
