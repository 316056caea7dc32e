// SPDX-License-Identifier: MIT
#include "algorithms/inference/evidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "foundation/random.hpp"

namespace tribench::loop::evidence_test {
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
  EffectBlock measured = {{0, 1, 2}, 0.5};
  measured.metric = Eigen::Vector3d(0.6, 0.3, 0.1).asDiagonal();
  measured.metric(0, 1) = measured.metric(1, 0) = 0.2;
  for (const EffectBlock& block : {EffectBlock{{0}}, EffectBlock{{1, 2}, 0.5}, measured}) {
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

// A column that explains nothing at all is ruled out at the rate n^(9/2).
TEST(EvidenceTable, AnAbsentColumnCostsAsItsRowsDo) {
  Eigen::MatrixXd column(100, 1);
  Eigen::VectorXd target(100);
  for (Eigen::Index i = 0; i < 100; ++i) {
    column(i, 0) = i % 2 == 0 ? 1 : -1;
    target[i] = i % 4 < 2 ? 1 : -1;
  }
  const EvidenceTable table = table_of(Eigen::MatrixXd::Ones(100, 1), column, target);
  EXPECT_NEAR(log_factor(table, {{0}}), -4.5 * std::log(26), 1e-10);
  EXPECT_NEAR(log_factor(table, {{0}, 2}), -4.5 * std::log(101), 1e-10);
}

// One column: a normal prior of a variance, a noise of unknown size, and the eighth power of the
// coefficient, its mean over the posterior against that over the prior.
TEST(EvidenceTable, OfOneColumnIsWhatIntegrationGives) {
  constexpr Eigen::Index kMany = 64;
  Eigen::VectorXd column(kMany);
  Eigen::VectorXd target(kMany);
  for (Eigen::Index i = 0; i < kMany; ++i) {
    column[i] = i % 2 == 0 ? 1 : -1;
    target[i] = 0.4 * column[i] + (i % 4 < 2 ? 1 : -1);
  }
  const EvidenceTable table = table_of(Eigen::MatrixXd::Ones(kMany, 1), column, target);
  for (const double size : {0.5, 1.0, 3.0}) {
    const double prior = size * size / 4;
    const double dof = kMany - 1;
    const double before = target.squaredNorm();
    const double covariance = 1 / (1 + kMany * prior);  // in units of the prior's
    const double product = column.dot(target) * std::sqrt(prior);
    const double after = before - product * product * covariance;
    const double length = product * covariance * product * covariance * dof / after;
    // Moments of the precision over its mean, to the powers 2, 3 and 4.
    const double second = 1 + 2 / dof;
    const double third = second * (1 + 4 / dof);
    const double fourth = third * (1 + 6 / dof);
    const double eighth_power =
        fourth * std::pow(length, 4) + 28 * third * std::pow(length, 3) * covariance +
        210 * second * std::pow(length * covariance, 2) + 420 * length * std::pow(covariance, 3) +
        105 * std::pow(covariance, 4);
    const double expected = 0.5 * std::log(covariance) - dof / 2 * std::log(after / before) +
                            std::log(eighth_power / 105);
    EXPECT_NEAR(log_factor(table, {{0}, size}), expected, 1e-9) << size;
  }
}

// Nothing is left of a target that a column is, but rounding; that is told from nothing.
TEST(EvidenceTable, OfAPerfectFitIsFinite) {
  RandomStream random(23);
  const Eigen::MatrixXd column = 1e12 * normals(40, 1, random);
  const EvidenceTable table = table_of(Eigen::MatrixXd::Zero(40, 1), column, column.col(0));
  const EffectBlock block = {{0}};
  const double variance = table.posterior(std::array<const EffectBlock*, 1>{&block}).variance;
  EXPECT_NEAR(variance / (column.squaredNorm() / 40), 1e-12, 1e-16);
  EXPECT_TRUE(std::isfinite(log_factor(table, block)));
}

// As many columns in the base as rows: one degree of freedom is left.
TEST(EvidenceTable, KeepsOneDegreeOfFreedom) {
  RandomStream random(24);
  const Eigen::VectorXd target = normals(3, 1, random);
  EXPECT_EQ(table_of(normals(3, 3, random), normals(3, 1, random), target).degrees_of_freedom(), 1);
  EXPECT_EQ(table_of(normals(3, 1, random), normals(3, 1, random), target).degrees_of_freedom(), 2);
}

// Two columns of the base are two where what is across is more than rounding of their products.
TEST(EvidenceTable, BaseColumnsAreOneWhereTheyDifferByRounding) {
  const auto degrees = [](double apart) {
    Eigen::MatrixXd base = Eigen::MatrixXd::Ones(64, 2);
    for (Eigen::Index i = 0; i < 64; ++i) base(i, 1) += i % 2 == 0 ? apart : -apart;
    RandomStream random(25);
    return table_of(base, normals(64, 1, random), normals(64, 1, random)).degrees_of_freedom();
  };
  // Of unit columns with a cosine c the eigenvalues are 1 - c and 1 + c: a share of apart^2 / 4.
  EXPECT_EQ(degrees(std::sqrt(4 * 0.8e-10)), 63);
  EXPECT_EQ(degrees(std::sqrt(4 * 1.3e-10)), 62);
}

// Columns at right angles are ruled out each by itself, in units too in which the product of what
// they cost is no number.
TEST(EvidenceTable, AbsentColumnsCostWhatEachOfThemDoesInAnyUnit) {
  constexpr Eigen::Index kMany = 256;
  constexpr Eigen::Index kBlocks = 7;
  const auto walsh = [](Eigen::Index row, Eigen::Index j) { return (row >> j) % 2 == 0 ? 1 : -1; };
  for (const double unit : {1.0, 1e30}) {
    const Eigen::MatrixXd columns = Eigen::MatrixXd::NullaryExpr(
        kMany, kBlocks, [&](Eigen::Index i, Eigen::Index j) { return unit * walsh(i, j); });
    const Eigen::VectorXd target =
        Eigen::VectorXd::NullaryExpr(kMany, [&](Eigen::Index i) { return walsh(i, kBlocks); });
    std::vector<EffectBlock> blocks;
    for (Eigen::Index j = 0; j < kBlocks; ++j) blocks.push_back({{j}});
    std::vector<const EffectBlock*> all;
    for (const EffectBlock& block : blocks) all.push_back(&block);
    const double each = -4.5 * std::log1p(0.25 * kMany * unit * unit);
    const EvidenceTable table = table_of(Eigen::MatrixXd::Ones(kMany, 1), columns, target);
    EXPECT_NEAR(table.log_factor(all), kBlocks * each, 1e-9 * std::abs(each));
  }
}

// Two columns that are nearly one make no effect where they cancel: what is absent is ruled out as
// if they were one.
TEST(EvidenceTable, ColumnsThatCancelAreNoEffect) {
  RandomStream random(4);
  constexpr Eigen::Index kMany = 4000;
  Eigen::MatrixXd columns = normals(kMany, 2, random);
  columns.col(1) = columns.col(0) + 0.01 * columns.col(1);
  const EvidenceTable table =
      table_of(Eigen::MatrixXd::Ones(kMany, 1), columns, normals(kMany, 1, random));
  EffectBlock alike = {{0, 1}};
  EXPECT_GT(log_factor(table, alike), -8);
  alike.metric = Eigen::Matrix2d::Constant(0.5);
  EXPECT_LT(log_factor(table, alike), -12);
}

// A misfit with the effect's own shape would cancel an effect that is not there, so that no number
// of rows ruled it out.
TEST(EvidenceTable, AMisfitDoesNotCancelAnAbsentEffect) {
  const auto factor = [](Eigen::Index rows, bool knows_what_is_shared) {
    RandomStream random(5);
    Eigen::MatrixXd columns = normals(rows, 2, random);
    columns.col(1) = 0.27 * (columns.col(0) + 0.3 * columns.col(1));
    EffectBlock block = {{0}, 0.4, {1}};
    if (knows_what_is_shared) block.shared = Eigen::MatrixXd::Constant(1, 1, 0.27);
    const Eigen::VectorXd target = normals(rows, 1, random);
    return log_factor(table_of(Eigen::MatrixXd::Ones(rows, 1), columns, target), block);
  };
  EXPECT_LT(factor(40000, true), -14);
  EXPECT_LT(factor(40000, true), factor(40000, false) - 4);
}

TEST(EvidenceTable, AMisfitsShareOfTheEffectIsTheEffects) {
  RandomStream random(6);
  Eigen::MatrixXd columns = normals(3000, 2, random);
  columns.col(1) = columns.col(0) + 0.5 * columns.col(1);
  const Eigen::VectorXd target = columns * Eigen::Vector2d(1, 0.6) + normals(3000, 1, random);
  EffectBlock block = {{0}, 1, {1}};
  block.shared = Eigen::MatrixXd::Constant(1, 1, 1);
  const EvidenceTable table = table_of(Eigen::MatrixXd::Ones(3000, 1), columns, target);
  const auto found = table.posterior(std::array<const EffectBlock*, 1>{&block});
  EXPECT_NEAR(found.effects[0], 1.6, 0.06);
  EXPECT_NEAR(found.mean[0], 1, 0.15);
  EXPECT_NEAR(found.mean[1], 0.6, 0.15);
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
  const Eigen::Vector3d precision(4, 8, 8);
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

// Which units the base is written in, and whether it says a thing twice, changes nothing.
TEST(EvidenceTable, DependsOnWhatTheBaseSpansAlone) {
  RandomStream random(21);
  const Eigen::MatrixXd base = normals(60, 2, random);
  const Eigen::MatrixXd columns = normals(60, 2, random);
  const Eigen::VectorXd target = columns.col(0) + normals(60, 1, random);
  const EffectBlock block{{0, 1}};
  const EvidenceTable plain = table_of(base, columns, target);
  Eigen::MatrixXd scaled = base;
  scaled.col(0) *= 1e-9;
  scaled.col(1) *= 1e7;
  EXPECT_NEAR(log_factor(table_of(scaled, columns, target), block), log_factor(plain, block), 1e-6);
  Eigen::MatrixXd twice(60, 4);
  twice << base, base.col(0) + base.col(1), Eigen::VectorXd::Zero(60);
  const EvidenceTable again = table_of(twice, columns, target);
  EXPECT_EQ(again.degrees_of_freedom(), plain.degrees_of_freedom());
  EXPECT_NEAR(log_factor(again, block), log_factor(plain, block), 1e-6);
}

TEST(EvidenceTable, SaysNothingWithoutBlocksOrOfATargetThatIsWhollyExplained) {
  RandomStream random(22);
  const Eigen::MatrixXd base = Eigen::MatrixXd::Ones(30, 1);
  const Eigen::MatrixXd columns = normals(30, 2, random);
  const EffectBlock block{{0, 1}};
  EXPECT_EQ(log_factor(table_of(base, columns, Eigen::VectorXd::Zero(30)), block), 0);
  const Eigen::VectorXd target = normals(30, 1, random);
  const EvidenceTable table = table_of(base, columns, target);
  EXPECT_EQ(table.log_factor({}), 0);
  EXPECT_EQ(table.degrees_of_freedom(), 29);
  const Eigen::VectorXd left = target.array() - target.mean();
  EXPECT_NEAR(table.posterior({}).variance, left.squaredNorm() / 29, 1e-9);
  const Eigen::VectorXd products = table.left_of_products({});
  EXPECT_NEAR(products[0], columns.col(0).dot(left), 1e-9);
  EXPECT_NEAR(products[1], columns.col(1).dot(left), 1e-9);
}

struct Drawn {
  Eigen::MatrixXd base;
  Eigen::MatrixXd columns;
  Eigen::VectorXd target;
};

// `size`: of the first of four columns, in the noise's.
Drawn draw(int rows, double size, std::uint64_t seed) {
  RandomStream random(seed);
  Drawn out{Eigen::MatrixXd::Ones(rows, 2), Eigen::MatrixXd(rows, 4), Eigen::VectorXd(rows)};
  for (int i = 0; i < rows; ++i) {
    out.base(i, 1) = random.normal();
    for (int j = 0; j < 4; ++j) out.columns(i, j) = random.normal();
    out.target[i] = 5 - 3 * out.base(i, 1) + 0.2 * (size * out.columns(i, 0) + random.normal());
  }
  return out;
}

EvidenceTable table_of(const Drawn& data) { return table_of(data.base, data.columns, data.target); }

double log_factor(const Drawn& data, const ColumnBlock& block) {
  return log_factor(table_of(data), EffectBlock{block});
}

TEST(EvidenceSums, GrowsWithWhatIsThereAndFallsWithWhatIsNot) {
  const Drawn few = draw(100, 1, 1);
  const Drawn many = draw(1000, 1, 1);
  EXPECT_GT(log_factor(few, {0}), 10);
  EXPECT_GT(log_factor(many, {0}), 100);
  EXPECT_LT(log_factor(few, {1}), -2);
  EXPECT_LT(log_factor(many, {1}), log_factor(few, {1}) - 1);
  EXPECT_LT(log_factor(many, {1, 2}), -4);
}

TEST(EvidenceSums, IsTheSameForAnyBaseCoefficientsAndAnyNoise) {
  const Drawn data = draw(200, 0.5, 2);
  Drawn other = data;
  other.target = 7 * data.target + data.base * Eigen::Vector2d(-11, 4);
  EXPECT_NEAR(log_factor(data, {0}), log_factor(other, {0}), 1e-7);
}

// The mean of a Bayes factor where the base alone is true is 1: rarely is it large, at any time.
TEST(EvidenceSums, IsRarelyLargeWhereNothingIsMissingHoweverOftenOneLooks) {
  int large = 0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    const Drawn data = draw(300, 0, 100 + static_cast<std::uint64_t>(run));
    bool ever = false;
    for (int rows = 10; rows <= 300; rows += 10) {
      const Drawn part{data.base.topRows(rows), data.columns.topRows(rows), data.target.head(rows)};
      ever = ever || log_factor(part, {0}) > std::log(20.0);
    }
    large += ever ? 1 : 0;
  }
  EXPECT_LE(large, kRuns / 20);
}

TEST(EvidenceSums, PosteriorIsWhatWasPlanted) {
  const Drawn data = draw(2000, 2, 3);
  const EffectBlock block{{0}};
  const std::array<const EffectBlock*, 1> blocks = {&block};
  const EvidenceTable::Posterior found = table_of(data).posterior(blocks);
  EXPECT_NEAR(found.mean[0], 0.4, 0.02);
  EXPECT_NEAR(std::sqrt(found.variance), 0.2, 0.01);
}

}  // namespace
}  // namespace tribench::loop::evidence_test
