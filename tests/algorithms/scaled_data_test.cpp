// SPDX-License-Identifier: MIT
#include "algorithms/scaled_data.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"far", "near"};

struct Rows {
  std::vector<Input> inputs = {{"far", "", Role::none, 0, 4e-140, {}},
                               {"near", "", Role::none, -2, 2, {}}};
  std::vector<double> far = {1e-140, 2.5e-140, 4e-140, NAN};
  std::vector<double> near = {-2, 0.5, 1, 2};
  std::vector<double> target = {3e90, -1e90, NAN, 2e89};
  std::vector<const double*> columns = {far.data(), near.data()};
  std::vector<int> movement = {0, 0, 1, 1};
  TrainingData data() const { return {inputs, columns, target, movement}; }
};

TEST(ScaledData, BringsFarColumnsNearOneAndLeavesTheOthersWhereTheyLie) {
  const Rows rows;
  const ScaledData scaled(rows.data());
  const TrainingData seen = scaled.data();
  EXPECT_TRUE(scaled.is_scaled());
  EXPECT_EQ(seen.columns[1], rows.near.data());
  for (std::size_t r = 0; r < 3; ++r) EXPECT_LT(std::abs(std::log10(seen.columns[0][r])), 1);
  EXPECT_TRUE(std::isnan(seen.columns[0][3]));
  EXPECT_LT(std::abs(seen.target[0]), 2);
  EXPECT_TRUE(std::isnan(seen.target[2]));
  // The box is that of the scaled numbers, to the bit.
  EXPECT_EQ(seen.inputs[0].high / seen.columns[0][2], 1);
  EXPECT_EQ(seen.inputs[1].high, 2);
}

TEST(ScaledData, WritesAFormulaInTheDatasOwnNumbersWithTheSameBits) {
  const Rows rows;
  const ScaledData scaled(rows.data());
  const TrainingData seen = scaled.data();
  const Expression found = parse("0.3*far*near + 1.7*far - near/3", kNames);
  std::vector<double> inside(4);
  std::vector<double> outside(4);
  Evaluator().evaluate(found, seen.table(), inside);
  Evaluator().evaluate(scaled.unscaled(found), rows.data().table(), outside);
  const double factor = rows.target[0] / seen.target[0];
  for (std::size_t r = 0; r < 3; ++r) EXPECT_EQ(outside[r], inside[r] * factor);
}

// 2^1074, which the smallest number is brought near 1 by, is no double.
TEST(ScaledData, WritesAFormulaOverNumbersThatNoFactorReaches) {
  Rows rows;
  rows.far = {3e-310, -1e-309, 2e-310, 0};
  const ScaledData scaled(rows.data());
  const TrainingData seen = scaled.data();
  const Expression found = parse("2*far + 1", kNames);
  std::vector<double> inside(4);
  std::vector<double> outside(4);
  Evaluator().evaluate(found, seen.table(), inside);
  const Expression written = scaled.unscaled(found);
  Evaluator().evaluate(written, rows.data().table(), outside);
  const double factor = rows.target[0] / seen.target[0];
  for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(outside[r], inside[r] * factor);
  for (const Node& node : written.nodes()) EXPECT_TRUE(std::isfinite(node.value));
}

TEST(ScaledData, HandsOnWhatLiesWhereFitsCanCompute) {
  Rows rows;
  rows.far = {1e-30, 2e-30, 3e-30, 0};
  rows.target = {1e30, 0, NAN, 1};
  const ScaledData scaled(rows.data());
  EXPECT_FALSE(scaled.is_scaled());
  EXPECT_EQ(scaled.data().columns[0], rows.far.data());
  EXPECT_EQ(scaled.data().target.data(), rows.target.data());
  const Expression formula = parse("far + near", kNames);
  EXPECT_EQ(scaled.unscaled(formula), formula);
}

}  // namespace
}  // namespace tribench
