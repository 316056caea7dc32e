// SPDX-License-Identifier: MIT
#include "algorithms/fitting/gaussian_process.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tribench {
namespace {

struct Waves {
  Eigen::MatrixXd points;
  Eigen::VectorXd truth;
  Eigen::VectorXd target;

  // sin(2 x) of a first input, nothing of a second; noise of 0.3.
  explicit Waves(Eigen::Index rows) : points(rows, 2), truth(rows), target(rows) {
    RandomStream random(key_of("waves"));
    for (Eigen::Index r = 0; r < rows; ++r) {
      points(r, 0) = random.uniform(-1.7, 1.7);
      points(r, 1) = random.uniform(-1.7, 1.7);
      truth[r] = std::sin(2 * points(r, 0));
      target[r] = truth[r] + 0.3 * random.normal();
    }
  }
};

Eigen::MatrixXd scaled(const Eigen::MatrixXd& points, const Eigen::VectorXd& lengths) {
  return points.array().rowwise() / lengths.transpose().array();
}

TEST(GaussianProcess, WeighsTwoRowsAsComputedByHand) {
  Eigen::MatrixXd points(2, 1);
  points << 0, 1;
  const Eigen::VectorXd target = Eigen::Vector2d(1, 3);
  GaussianProcess process;
  ASSERT_TRUE(process.train(points, target, 1, 0.5, 0.25));
  // K = [a b; b a] with a = 1.75, b = exp(-1/2) + 0.25.
  const double a = 1.75;
  const double b = std::exp(-0.5) + 0.25;
  const double det = a * a - b * b;
  const double w0 = (a * 1 - b * 3) / det;
  const double w1 = (a * 3 - b * 1) / det;
  EXPECT_NEAR(process.mean_at(Eigen::VectorXd::Constant(1, 0)), 1.25 * w0 + b * w1, 1e-12);
  EXPECT_NEAR(process.variance(), (w0 + 3 * w1) / 2, 1e-12);
}

TEST(GaussianProcess, LeavesOneOutAsIfItHadBeenTrainedWithoutIt) {
  const Waves data(25);
  GaussianProcess process;
  ASSERT_TRUE(process.train(data.points, data.target, 0.8, 0.1));
  const std::vector<double> errors = process.leave_one_out_errors();
  for (Eigen::Index left = 0; left < 25; left += 6) {
    Eigen::MatrixXd points(24, 2);
    Eigen::VectorXd target(24);
    for (Eigen::Index r = 0, k = 0; r < 25; ++r) {
      if (r == left) continue;
      points.row(k) = data.points.row(r);
      target[k++] = data.target[r];
    }
    GaussianProcess without;
    ASSERT_TRUE(without.train(points, target, 0.8, 0.1));
    EXPECT_NEAR(errors[static_cast<std::size_t>(left)],
                std::abs(data.target[left] - without.mean_at(data.points.row(left).transpose())),
                1e-9);
  }
}

TEST(GaussianProcess, HasTheGradientOfItsLikelihood) {
  const Waves data(30);
  const Covariance at{Eigen::Vector2d(0.7, 3), 0.2, 0.5};
  Eigen::VectorXd gradient;
  log_likelihood(data.points, data.target, at, &gradient);
  constexpr double kStep = 1e-5;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const auto moved = [&](double by) {
      Covariance covariance = at;
      double& value =
          k < 2 ? covariance.lengths[k] : (k == 2 ? covariance.noise : covariance.constant);
      value *= std::exp(by);
      return log_likelihood(data.points, data.target, covariance);
    };
    EXPECT_NEAR(gradient[k], (moved(kStep) - moved(-kStep)) / (2 * kStep), 1e-5) << k;
  }
}

TEST(GaussianProcess, FindsTheNoiseAndTheInputThatMatters) {
  const Waves data(150);
  const Covariance likely = most_likely_covariance(data.points, data.target, 20, RandomStream(3));
  EXPECT_GT(likely.lengths[1], 5 * likely.lengths[0]);
  GaussianProcess process;
  const Eigen::MatrixXd points = scaled(data.points, likely.lengths);
  ASSERT_TRUE(process.train(points, data.target, 1, likely.noise, likely.constant));
  const double drawn = std::sqrt((data.target - data.truth).squaredNorm() / 150);
  EXPECT_NEAR(std::sqrt(likely.noise * process.variance()), drawn, 0.02);
  double error = 0;
  for (Eigen::Index r = 0; r < 150; ++r) {
    error += std::pow(process.mean_at(points.row(r).transpose()) - data.truth[r], 2) / 150;
  }
  EXPECT_LT(std::sqrt(error), 0.1);
}

TEST(GaussianProcess, SaysWhenNothingCanBeFactored) {
  const Eigen::MatrixXd points = Eigen::MatrixXd::Zero(3, 1);
  GaussianProcess process;
  EXPECT_FALSE(process.train(points, Eigen::Vector3d(1, 2, 3), 1, 0));
}

}  // namespace
}  // namespace tribench
