// SPDX-License-Identifier: MIT
#include "harness/searches_anew.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

const std::vector<std::string> kOneName = {"v"};
const std::vector<Input> kOneInput = {{"v", "-", Role::none, -1, 1, std::nullopt}};

FitResult front_of(const std::vector<std::string>& front, std::size_t chosen) {
  FitResult result;
  for (const std::string& formula : front) result.front.push_back(parse(formula, kOneName));
  result.chosen = chosen;
  return result;
}

// Rows of v, off by 0.2 this way and that, four a movement.
class SearchesAnewTest : public ::testing::Test {
 protected:
  void fill(int rows) {
    for (int r = 0; r < rows; ++r) {
      v_.push_back(2.0 * r / rows - 1);
      target_.push_back(v_.back() + (r % 2 == 0 ? 0.2 : -0.2));
      movement_.push_back(r / 4);
    }
  }
  // What becomes of a fit whose search, made anew, answers so.
  FitResult looked_at(FitResult fit, const FitResult& anew) {
    const double* column = v_.data();
    const TrainingData data{kOneInput, {&column, 1}, target_, movement_};
    Budget budget({.evaluations = 1000});
    const auto search = [&](const TrainingData& rows, RandomStream stream, Budget& part) {
      EXPECT_TRUE(part.spend(150));
      keys_.insert(stream.key());
      std::map<int, int> rows_of;
      for (const int one : rows.movement) ++rows_of[one];
      for (const auto& [movement, count] : rows_of) rows_of_a_movement_.push_back(count);
      searched_.push_back(rows.rows());
      return anew;
    };
    look_at_choice(fit, search, data, budget, RandomStream(3));
    return fit;
  }

  std::vector<double> v_;
  std::vector<double> target_;
  std::vector<int> movement_;
  std::vector<std::size_t> searched_;
  std::vector<int> rows_of_a_movement_;
  std::set<std::uint64_t> keys_;
};

TEST_F(SearchesAnewTest, WhatErrsOnRowsItHasNotSeenGivesWay) {
  fill(60);
  const FitResult result =
      looked_at(front_of({"0", "0.9*v", "v + 3*v^8"}, 2), front_of({"0", "1.1*v", "v - 4*v^8"}, 2));
  EXPECT_EQ(result.chosen, 1U);
  EXPECT_THAT(result.note, HasSubstr("simpler"));
  EXPECT_THAT(searched_, Each(48U));
  EXPECT_THAT(rows_of_a_movement_, Each(4));  // whole movements are held out
  EXPECT_EQ(keys_.size(), 5U);
}

TEST_F(SearchesAnewTest, WhatHoldsThereStands) {
  fill(60);
  const FitResult result =
      looked_at(front_of({"0", "v", "v + 3*v^8"}, 2), front_of({"0", "9*v", "v + 0.1*v^8"}, 2));
  EXPECT_EQ(result.chosen, 2U);
  EXPECT_EQ(result.note, "");
}

TEST_F(SearchesAnewTest, NothingIsSearchedForExactFormulasOrManyRows) {
  fill(60);
  target_ = v_;
  EXPECT_EQ(looked_at(front_of({"0", "v"}, 1), front_of({"0"}, 0)).chosen, 1U);
  fill(400);
  EXPECT_EQ(looked_at(front_of({"0", "v^3"}, 1), front_of({"0"}, 0)).chosen, 1U);
  EXPECT_TRUE(searched_.empty());
}

TEST_F(SearchesAnewTest, ASearchWithoutAnAnswerSaysNothing) {
  fill(60);
  EXPECT_EQ(looked_at(front_of({"0", "v", "v + 3*v^8"}, 2), FitResult{}).chosen, 2U);
  EXPECT_EQ(searched_.size(), 1U);
}

}  // namespace
}  // namespace tribench
