// SPDX-License-Identifier: MIT
#include "algorithms/inference/evidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop {
namespace {

constexpr Eigen::Index kRows = 14;

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index columns, RandomStream& random) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.normal(); });
}

EvidenceTable table_of(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                       const Eigen::VectorXd& target) {
  EvidenceSums sums;
  sums.add(base, columns, target);
  return EvidenceTable(sums);
}

double log_factor(const EvidenceTable& table, const EffectBlock& block) {
  return table.log_factor(std::array<const EffectBlock*, 1>{&block});
}

// Under the base the factor's expectation is 1, whatever base and noise are: what makes it valid
// whenever one looks.
TEST(EvidenceTable, FactorsAverageToOneUnderTheBase) {
  RandomStream random(key_of("evidence"));
  const Eigen::MatrixXd base = normals(kRows, 2, random);
  const Eigen::MatrixXd columns = normals(kRows, 3, random);
  for (const EffectBlock& block : {EffectBlock{{0}}, EffectBlock{{1, 2}, 0.5}}) {
    constexpr int kRuns = 20000;
    double sum = 0;
    double squares = 0;
    for (int run = 0; run < kRuns; ++run) {
      const Eigen::VectorXd target = 7 * base.col(1) + 3 * normals(kRows, 1, random);
      const double factor = std::exp(log_factor(table_of(base, columns, target), block));
      sum += factor;
      squares += factor * factor;
    }
    const double mean = sum / kRuns;
    EXPECT_NEAR(mean, 1, 4 * std::sqrt((squares / kRuns - mean * mean) / kRuns));
  }
}

TEST(EvidenceTable, FavoursWhatIsThere) {
  RandomStream random(2);
  const Eigen::MatrixXd base = Eigen::MatrixXd::Ones(200, 1);
  const Eigen::MatrixXd columns = normals(200, 2, random);
  const Eigen::VectorXd target = columns.col(0) + normals(200, 1, random);
  const EvidenceTable table = table_of(base, columns, target);
  EXPECT_GT(log_factor(table, {{0}}), 20);
  EXPECT_LT(log_factor(table, {{1}}), -3);
  EXPECT_EQ(table.log_factor({}), 0);
  EXPECT_EQ(table.degrees_of_freedom(), 199);
}

// A column that explains nothing at all is ruled out at the rate n^(3/2).
TEST(EvidenceTable, AnAbsentColumnCostsAsItsRowsDo) {
  Eigen::MatrixXd column(100, 1);
  Eigen::VectorXd target(100);
  for (Eigen::Index i = 0; i < 100; ++i) {
    column(i, 0) = i % 2 == 0 ? 1 : -1;
    target[i] = i % 4 < 2 ? 1 : -1;
  }
  const EvidenceTable table = table_of(Eigen::MatrixXd::Ones(100, 1), column, target);
  EXPECT_NEAR(log_factor(table, {{0}}), -1.5 * std::log(101), 1e-10);
  EXPECT_NEAR(log_factor(table, {{0}, 2}), -1.5 * std::log(401), 1e-10);
}

// The posterior of normal coefficients with a prior of unit covariance over the block's size.
TEST(EvidenceTable, PosteriorIsThatOfTheNormalPrior) {
  RandomStream random(3);
  const Eigen::MatrixXd columns = normals(50, 3, random);
  const Eigen::VectorXd target = columns * Eigen::Vector3d(1, -0.5, 0.25) + normals(50, 1, random);
  const EvidenceTable table = table_of(Eigen::MatrixXd::Zero(50, 1), columns, target);
  const EffectBlock one = {{0}};
  const EffectBlock two = {{1, 2}};
  const auto found = table.posterior(std::array<const EffectBlock*, 2>{&one, &two});
  const Eigen::Vector3d precision(1, 2, 2);
  const Eigen::MatrixXd normal =
      columns.transpose() * columns + Eigen::MatrixXd(precision.asDiagonal());
  const Eigen::VectorXd mean = normal.inverse() * columns.transpose() * target;
  EXPECT_LT((found.mean - mean).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(found.variance, (target - columns * mean).dot(target) / 50, 1e-10);
  // What the columns still see of what is left.
  const Eigen::VectorXd left =
      table.left_of_products(std::array<const EffectBlock*, 2>{&one, &two});
  EXPECT_LT((left - columns.transpose() * (target - columns * mean)).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace tribench::loop
