// SPDX-License-Identifier: MIT
#include "harness/searches_anew.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
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
  TrainingData data() {
    column_ = v_.data();
    return {kOneInput, {&column_, 1}, target_, movement_};
  }
  // Of a fit whose search, made anew, answers so.
  std::optional<Bearable> bearable(const FitResult& fit, const FitResult& anew) {
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
    return bearable_search(fit, search, data(), budget, RandomStream(3));
  }
  FitResult kept_within(int complexity, FitResult fit) {
    keep_bearable({complexity, true, {}}, data(), fit);
    return fit;
  }

  const double* column_ = nullptr;
  std::vector<double> v_;
  std::vector<double> target_;
  std::vector<int> movement_;
  std::vector<std::size_t> searched_;
  std::vector<int> rows_of_a_movement_;
  std::set<std::uint64_t> keys_;
};

TEST_F(SearchesAnewTest, WhatErrsOnRowsItHasNotSeenIsTooComplexAndMoreOfItInVain) {
  fill(60);
  const auto found = bearable(front_of({"0", "0.9*v", "v + 0.1*v^8"}, 2),
                              front_of({"0", "1.1*v", "v - 4*v^8"}, 2));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->complexity, 2);
  EXPECT_FALSE(found->is_more_worth_it);
  EXPECT_THAT(searched_, Each(48U));
  EXPECT_THAT(rows_of_a_movement_, Each(4));  // whole movements are held out
  EXPECT_EQ(keys_.size(), 5U);
}

TEST_F(SearchesAnewTest, WhatHoldsThereIsNot) {
  fill(60);
  const auto found =
      bearable(front_of({"0", "v", "v + 0.1*v^8"}, 2), front_of({"0", "9*v", "v + 0.2*v^8"}, 2));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->complexity, 5);
  EXPECT_TRUE(found->is_more_worth_it);
}

TEST_F(SearchesAnewTest, EachMaySpendAQuarterOfWhatTheFirstDidOrNoneIsMade) {
  EXPECT_TRUE(is_enough_for_searches_anew({.evaluations = 1000}, {.evaluations = 600}));
  EXPECT_FALSE(is_enough_for_searches_anew({.evaluations = 1000}, {.evaluations = 500}));
  EXPECT_TRUE(is_enough_for_searches_anew({.cpu_seconds = 60}, {.cpu_seconds = 40}));
  EXPECT_FALSE(is_enough_for_searches_anew({.cpu_seconds = 36}, {.cpu_seconds = 6}));
}

TEST_F(SearchesAnewTest, NothingIsSearchedForExactFormulasOrManyRows) {
  fill(60);
  target_ = v_;
  EXPECT_FALSE(bearable(front_of({"0", "v"}, 1), front_of({"0"}, 0)));
  fill(400);
  EXPECT_FALSE(bearable(front_of({"0", "v^3"}, 1), front_of({"0"}, 0)));
  EXPECT_TRUE(searched_.empty());
}

TEST_F(SearchesAnewTest, ASearchWithoutAnAnswerSaysNothing) {
  fill(60);
  EXPECT_FALSE(bearable(front_of({"0", "v", "v + 3*v^8"}, 2), FitResult{}));
  EXPECT_EQ(searched_.size(), 1U);
}

TEST_F(SearchesAnewTest, TheChoiceIsKeptWithinTheBoundUnlessItIsExact) {
  fill(60);
  const FitResult fit = front_of({"0", "v", "0.9*v", "v + 3*v^8"}, 3);
  const FitResult kept = kept_within(3, fit);
  EXPECT_EQ(kept.chosen, 2U);
  EXPECT_THAT(kept.note, HasSubstr("more than 3 operations"));
  EXPECT_EQ(kept_within(5, fit).chosen, 3U);
  EXPECT_EQ(kept_within(5, fit).note, "");
  target_ = v_;
  EXPECT_EQ(kept_within(0, front_of({"0", "v"}, 1)).chosen, 1U);
}

TEST_F(SearchesAnewTest, AChoiceThatHasGoneAstrayGivesWayToWhatTheOthersFound) {
  fill(60);
  const FitResult fit = front_of({"0", "0.5*v", "v + 40*v^9"}, 2);
  const std::vector<Expression> found =
      front_of({"0.9*v", "0.8*v", "1.1*v", "v + v^3", "1.2*v"}, 0).front;
  FitResult kept = fit;
  keep_bearable({9, true, found}, data(), kept);
  ASSERT_EQ(kept.front.size(), 4U);
  EXPECT_EQ(kept.chosen, 2U);
  EXPECT_THAT(kept.note, HasSubstr("median"));
  // Its number is fitted to all rows: 1, but for the noise.
  EXPECT_NEAR(kept.front[2].nodes()[0].value + kept.front[2].nodes()[1].value, 1, 0.2);

  FitResult typical = front_of({"0", "1.1*v"}, 1);
  keep_bearable({9, true, found}, data(), typical);
  EXPECT_EQ(typical.front.size(), 2U);
  EXPECT_EQ(typical.note, "");
}

}  // namespace
}  // namespace tribench
