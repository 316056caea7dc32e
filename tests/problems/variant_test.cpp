// SPDX-License-Identifier: MIT
#include "problems/variant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"
#include "problems/catalogue.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

double deviation(const std::vector<double>& values) {
  double mean = 0;
  double square = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) {
    square += (value - mean) * (value - mean) / static_cast<double>(values.size());
  }
  return std::sqrt(square);
}

std::vector<double> added(const Problem& noisy, const Problem& clean) {
  std::vector<double> noise;
  const std::vector<double>& target = noisy.stages.front().train.target;
  for (std::size_t r = 0; r < target.size(); ++r) {
    noise.push_back(target[r] - clean.stages.front().train.target[r]);
  }
  return noise;
}

TEST(Variant, NoiseIsAShareOfTheTargetAndTheSameAtEveryLevel) {
  const Catalogue catalogue;
  const Problem clean = catalogue.find("A/j2/no_load").make(3);
  const Problem small = catalogue.find("A/j2/no_load~noise=0.1").make(3);
  const Problem large = catalogue.find("A/j2/no_load~noise=0.2").make(3);
  EXPECT_EQ(small.name, "A/j2/no_load~noise=0.1");
  EXPECT_EQ(small.test.target, clean.test.target);
  EXPECT_EQ(small.stages.front().law, clean.stages.front().law);
  const std::vector<double> noise = added(small, clean);
  const double share = deviation(noise) / deviation(clean.stages.front().train.target);
  EXPECT_NEAR(share, 0.1, 0.02);
  const std::vector<double> twice = added(large, clean);
  for (std::size_t r = 0; r < noise.size(); ++r) EXPECT_NEAR(twice[r], 2 * noise[r], 1e-9);
  EXPECT_EQ(catalogue.find("A/j2/no_load~noise=0").make(3).stages.front().train.target,
            clean.stages.front().train.target);
}

TEST(Variant, RowsAreSomeOfTheTrainingRowsInTheirOrder) {
  const Catalogue catalogue;
  const Problem whole = catalogue.find("A/j2/no_load").make(1);
  const Problem some = catalogue.find("A/j2/no_load~rows=20~noise=0").make(1);
  const Table& table = some.stages.front().train;
  EXPECT_EQ(table.rows(), 20U);
  EXPECT_EQ(table.columns.front().size(), 20U);
  EXPECT_TRUE(std::ranges::is_sorted(table.movement));
  const std::vector<double>& all = whole.stages.front().train.target;
  for (const double value : table.target) EXPECT_GT(std::ranges::count(all, value), 0);
  EXPECT_EQ(some.test.rows(), whole.test.rows());
}

TEST(Variant, RefusesWhatChangesNothing) {
  const Catalogue catalogue;
  for (const char* name : {"A/j2/no_load~nosie=1", "A/j2/no_load~noise=x", "A/j2/no_load~rows=1.5",
                           "A/j2/no_load~noise=-1", "A/j2/no_load~"}) {
    EXPECT_THROW(catalogue.find(name), Error) << name;
  }
  try {
    catalogue.find("A/j2/no_load~rows=999999").make(1);
    ADD_FAILURE() << "more rows than there are";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("not 999999"));
  }
}

}  // namespace
}  // namespace tribench
