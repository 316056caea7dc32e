// SPDX-License-Identifier: MIT
#include "problems/measured/entries.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "foundation/error.hpp"
#include "problems/catalogue.hpp"
#include "tests/support/paths.hpp"

namespace tribench::measured {
namespace {

TEST(MeasuredEntries, AreListedWithoutDataAndSayWhereTheyLooked) {
  const Catalogue catalogue{testing::scratch_folder()};
  const ProblemEntry& entry = catalogue.find("emps/estimation");
  try {
    entry.make(1);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("emps_estimation.csv"));
  }
}

TEST(MeasuredEntries, EveryProblemCanBeMadeAndKeepsItsPromises) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  const Catalogue catalogue(data);
  for (const Manifest& manifest : shipped_manifests()) {
    for (const ProblemPlan& plan : manifest.problems) {
      const Problem problem = catalogue.find(plan.name).make(3);
      const Table& train = problem.stages.front().train;
      EXPECT_GT(train.rows(), 20U) << plan.name;
      EXPECT_LE(train.rows(), 6000U) << plan.name;
      EXPECT_GT(problem.test.rows(), 0U) << plan.name;
      EXPECT_TRUE(problem.true_law().empty());
      if (plan.test_file.empty()) {
        const std::set<int> trained(train.movement.begin(), train.movement.end());
        for (const int movement : problem.test.movement) {
          EXPECT_EQ(trained.count(movement), 0U) << plan.name;
        }
      }
      for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
        for (const double value : problem.test.columns[j]) {
          EXPECT_GE(value, problem.inputs[j].low) << plan.name;
          EXPECT_LE(value, problem.inputs[j].high) << plan.name;
        }
      }
    }
  }
}

TEST(MeasuredEntries, TheSeedDrawsTheSplitAndNothingElse) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  const Catalogue catalogue(data);
  const auto sum = [&](std::uint64_t seed) {
    const Problem problem = catalogue.find("screw-drives/drive1_means").make(seed);
    double total = 0;
    for (const double y : problem.stages.front().train.target) total += std::abs(y);
    for (const double y : problem.test.target) total += std::abs(y);
    return std::make_pair(total, problem.test.target);
  };
  const auto [total, test] = sum(1);
  const auto [other_total, other_test] = sum(2);
  EXPECT_NEAR(total, other_total, 1e-12);
  EXPECT_NE(test, other_test);
  EXPECT_EQ(sum(1).second, test);
}

TEST(MeasuredEntries, FrictionIsPositiveWithVelocityInEverySet) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  const Catalogue catalogue(data);
  for (const char* name :
       {"screw-drives/drive1_means", "screw-drives/drive2_means", "emps/estimation",
        "ur10e-dynamic/j1", "ur10e-dynamic/j6", "ur10e-jointwise/j5", "kinova-gen3/j7"}) {
    const Problem problem = catalogue.find(name).make(1);
    std::size_t velocity = 0;
    while (problem.inputs[velocity].role != Role::velocity) ++velocity;
    const Table& train = problem.stages.front().train;
    double product = 0;
    for (std::size_t r = 0; r < train.rows(); ++r) {
      product += train.columns[velocity][r] * train.target[r];
    }
    EXPECT_GT(product, 0) << name;
  }
}

}  // namespace
}  // namespace tribench::measured
