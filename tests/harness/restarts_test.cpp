// SPDX-License-Identifier: MIT
#include "harness/restarts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kNames = {"v"};

// Rows of v^2 + noise, and rounds that answer with formulas given beforehand.
class RestartsTest : public ::testing::Test {
 protected:
  void fill(double noise) {
    for (int r = 0; r < 60; ++r) {
      v_.push_back(0.05 * r - 1);
      target_.push_back(v_.back() * v_.back() + (r % 2 == 0 ? noise : -noise));
    }
  }
  static FitResult answer(const std::vector<std::string>& front, std::size_t chosen) {
    FitResult result;
    for (const std::string& formula : front) result.front.push_back(parse(formula, kNames));
    result.chosen = chosen;
    return result;
  }
  // What becomes of the answers, each for ten evaluations.
  FitResult fit(std::vector<FitResult> answers, std::uint64_t evaluations = 1000,
                bool widens = false) {
    const double* column = v_.data();
    const std::vector<Input> inputs = {{"v", "-", Role::none, -1, 2, std::nullopt}};
    const TrainingData data{inputs, {&column, 1}, target_, {}};
    Budget budget({.evaluations = evaluations});
    budget.spend(10);
    asked_ = 1;
    const auto round = [&](RandomStream stream, int number) {
      keys_.push_back(stream.key());
      EXPECT_EQ(number, static_cast<int>(keys_.size()));
      const bool may = budget.spend(10);
      return may && asked_ < answers.size() ? answers[asked_++] : FitResult{};
    };
    return fit_until_spent(answers.front(), round, widens, data, budget, RandomStream(1));
  }
  static std::vector<std::string> texts(const FitResult& result) {
    std::vector<std::string> all;
    for (const Expression& formula : result.front) all.push_back(print(formula, kNames));
    return all;
  }

  std::vector<double> v_;
  std::vector<double> target_;
  std::size_t asked_ = 0;
  std::vector<std::uint64_t> keys_;
};

TEST_F(RestartsTest, GoOnUntilTheRowsAreExplained) {
  fill(0);
  const FitResult result = fit({answer({"v"}, 0), answer({"exp(v)"}, 0),
                                answer({"v^2", "v^2 + 0*v"}, 1), answer({"sin(v)"}, 0)});
  EXPECT_EQ(print(result.front[result.chosen], kNames), "v^2");  // exact, and the shortest
  EXPECT_EQ(asked_, 3U);
  EXPECT_THAT(result.note, HasSubstr("2 restarts"));
  ASSERT_EQ(keys_.size(), 2U);
  EXPECT_NE(keys_[0], keys_[1]);
}

TEST_F(RestartsTest, GoOnUntilTheBudgetIsSpentAndChooseByEvidence) {
  fill(0.1);
  std::vector<FitResult> answers(20, answer({"v", "1.02*v^2"}, 1));
  for (std::size_t i = 2; i < 20; i += 2) answers[i] = answer({"v"}, 0);
  answers[1] = answer({"v^3"}, 0);
  answers[3] = answer({"v", "v^2"}, 1);
  answers[5] = answer({"v", "1.1*v^2 - 0.1"}, 1);
  const FitResult result = fit(answers, 100);
  EXPECT_EQ(print(result.front[result.chosen], kNames), "v^2");
  EXPECT_EQ(keys_.size(), 9U);  // of ten evaluations each
}

// A round that had no time to hold its choice against as many rows that it had not seen does not
// overrule one that had.
TEST_F(RestartsTest, ChooseByWhatWasHeldOutOnMoreRows) {
  fill(0.1);
  const std::string longer = "v^2 - 0.001*cos(3*v)";  // a little nearer
  for (const std::size_t first_rows : {0, 40, 60}) {
    for (const std::size_t next_rows : {0, 40, 60}) {
      asked_ = 0;
      keys_.clear();
      std::vector<FitResult> answers = {answer({"v^2", longer}, 1), answer({"v^2"}, 0),
                                        answer({"v^2"}, 0)};
      answers[0].held_out_rows = first_rows;
      answers[1].held_out_rows = answers[2].held_out_rows = next_rows;
      const FitResult result = fit(answers);
      EXPECT_EQ(print(result.front[result.chosen], kNames),
                next_rows < first_rows ? print(parse(longer, kNames), kNames) : "v^2");
    }
  }
}

TEST_F(RestartsTest, EndWhereARoundGivesWhatTheRoundBeforeGave) {
  fill(0.1);
  const FitResult result = fit({answer({"v"}, 0), answer({"v"}, 0), answer({"v^2"}, 0)});
  EXPECT_EQ(asked_, 2U);
  EXPECT_EQ(texts(result), (std::vector<std::string>{"v"}));
}

TEST_F(RestartsTest, OfAMethodThatWidensGoOnThroughTwoThatGiveNothingNew) {
  fill(0.1);
  std::vector<FitResult> answers(10, answer({"v"}, 0));
  answers[3] = answer({"v^2"}, 0);
  const FitResult result = fit(answers, 1000, true);
  EXPECT_EQ(asked_, 8U);  // three alike after the fifth
  EXPECT_EQ(print(result.front[result.chosen], kNames), "v^2");
}

TEST_F(RestartsTest, KeepOneFrontByIncreasingComplexityAndFallingError) {
  fill(0.1);
  const FitResult result =
      fit({answer({"-9", "v^2 + v"}, 1), answer({"v", "v^2 + 0.01*v"}, 1), answer({"v"}, 0)});
  // v^2 + v is less complex than the last one and has more error than v: it is no part of a front.
  EXPECT_EQ(texts(result), (std::vector<std::string>{"-9", "v", "v^2 + 0.01*v"}));
  EXPECT_EQ(result.chosen, 2U);
}

TEST_F(RestartsTest, LeaveAMethodWithoutAnAnswerAlone) {
  fill(0);
  const FitResult result = fit({FitResult::unsupported("no")});
  EXPECT_TRUE(result.front.empty());
  EXPECT_EQ(result.note, "no");
}

}  // namespace
}  // namespace tribench
