// SPDX-License-Identifier: MIT
#include "algorithms/inference/feature_scores.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tribench::loop::feature_scores_test {
namespace {

constexpr double kRidge = 0.02;

// Movements of several lengths, some of which turn and stand still for a row.
struct Example {
  Clusters clusters;
  Noise noise;
  Eigen::VectorXf direction;
  FloatRows features;
  Eigen::MatrixXd model;  // columns, not whitened
  Eigen::VectorXd target;
};

// slow_share: of the noise; 0: rows are looked at as they are.
Example example(double slow_share, bool with_direction) {
  RandomStream random(5);
  Example e;
  std::vector<int> movement;
  std::vector<float> direction;
  for (int m = 0; m < 24; ++m) {
    const int rows = 20 + 9 * (m % 12);
    for (int i = 0; i < rows; ++i) {
      movement.push_back(m);
      const int turns = m % 3 == 0 ? (i + 7) / 15 : m;
      direction.push_back(i == 30 ? 0.0F : turns % 2 == 0 ? 1.0F : -1.0F);
    }
  }
  const auto n = static_cast<Eigen::Index>(movement.size());
  e.direction = Eigen::Map<Eigen::VectorXf>(direction.data(), with_direction ? n : 0);
  e.features.resize(n, 11);
  e.model.resize(n, 3);
  e.target.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (float& x : e.features.row(i)) x = static_cast<float>(random.normal() + 0.5);
    e.model.row(i) << 1, random.normal(), static_cast<double>(direction[i]);
    e.target[i] = random.normal() + 0.2 * static_cast<double>(e.features(i, 4));
  }
  e.clusters = make_clusters(movement, 1);
  e.clusters.weight = movement_weights(e.target, e.clusters);
  e.noise = estimate_noise(e.target, e.clusters, 3, 0);
  e.noise.slow_share = slow_share;
  e.noise.slow_rho = 0.8;
  e.noise.between_sd = 0.3;
  e.noise.whitened = slow_share > 0;
  return e;
}

// The same by the slow road: every column whitened and projected in double precision.
BlockScores by_columns(const Example& e, const Eigen::MatrixXd& basis,
                       const Eigen::VectorXd& residual) {
  Eigen::MatrixXd columns = e.features.cast<double>();
  if (e.direction.size() > 0) {
    const Eigen::MatrixXd turned = e.direction.cast<double>().asDiagonal() * columns;
    columns = beside(columns, turned);
  }
  const Eigen::MatrixXd zt = project_off(whitened(columns, e.clusters, e.noise), basis);
  Eigen::MatrixXd sums(static_cast<Eigen::Index>(e.clusters.stretches.size()), zt.cols());
  for (std::size_t c = 0; c < e.clusters.stretches.size(); ++c) {
    const auto begin = static_cast<Eigen::Index>(e.clusters.stretches[c].begin);
    const auto size = static_cast<Eigen::Index>(e.clusters.stretches[c].size());
    sums.row(static_cast<Eigen::Index>(c)) =
        residual.segment(begin, size).transpose() * zt.middleRows(begin, size);
  }
  return score_sums(zt.transpose() * zt, sums, kRidge);
}

TEST(FeatureScorer, SaysWhatTheColumnsSayOneByOne) {
  for (const bool with_direction : {true, false}) {
    for (const double slow_share : {0.0, 0.3, 1.0}) {
      const Example e = example(slow_share, with_direction);
      const Eigen::MatrixXd basis = orthonormal_basis(whitened(e.model, e.clusters, e.noise));
      const Eigen::VectorXd residual = project_off(whitened(e.target, e.clusters, e.noise), basis);
      const BlockScores slow = by_columns(e, basis, residual);
      const BlockScores fast = FeatureScorer(basis, residual, e.clusters, e.noise, e.direction)
                                   .score(e.features, kRidge);
      ASSERT_EQ(fast.whitened_sums.cols(), slow.whitened_sums.cols());
      EXPECT_NEAR(fast.test.statistic / slow.test.statistic, 1, 1e-4);
      EXPECT_NEAR(fast.test.score / slow.test.score, 1, 1e-4);
      // Cluster by cluster: the coordinates differ by a rotation, lengths do not.
      const Eigen::VectorXf a = fast.whitened_sums.rowwise().squaredNorm();
      const Eigen::VectorXf b = slow.whitened_sums.rowwise().squaredNorm();
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-4F * b.maxCoeff());
    }
  }
}

}  // namespace
}  // namespace tribench::loop::feature_scores_test
