// SPDX-License-Identifier: MIT
#include "algorithms/fitting/held_out_choice.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/linear_sum.hpp"
#include "foundation/random.hpp"

namespace tribench::held_out_choice_test {
namespace {

const std::vector<std::string> kNames = {"v"};

// Rows of 2 v with noise, and formulas over them.
struct Rows {
  std::vector<double> v;
  std::vector<double> target;
  const double* column = nullptr;

  explicit Rows(int count, double noise = 0.3) {
    RandomStream random(7);
    for (int r = 0; r < count; ++r) {
      v.push_back(random.uniform(-1, 1));
      target.push_back(2 * v.back() + noise * random.normal());
    }
    column = v.data();
  }
  std::size_t choice_of(const std::vector<std::string>& texts, std::size_t chosen) const {
    std::vector<Expression> front;
    for (const std::string& text : texts) front.push_back(parse(text, kNames));
    return held_out_choice(front, chosen, {{&column, 1}, v.size()}, target, {});
  }
};

// Through nearly every one of few rows, and far off between them.
const std::string kWild =
    "0.1 + 2*v + 3*v^2 + 4*v^3 + 5*v^4 + 6*v^5 + 7*v^6 + 8*v^7 + 9*v^8 + 10*v^9 + 11*v^10 + "
    "12*v^11 + 13*v^12 + 14*v^13 + 15*v^14";

TEST(HeldOutChoice, TakesThePlaceOfAFormulaThatFoldsSpeakPlainlyAgainst) {
  EXPECT_EQ(Rows(22).choice_of({"0.5", "2*v", kWild}, 2), 1U);
}

TEST(HeldOutChoice, StandsOnceThereIsNoTimeForAnotherFold) {
  const Rows rows(22);
  const Inputs table{{&rows.column, 1}, rows.v.size()};
  const std::vector<Expression> front = {parse("0.5", kNames), parse("2*v", kNames),
                                         parse(kWild, kNames)};
  int asked = 0;
  const auto nine_times = [&asked] { return ++asked < 10; };
  EXPECT_EQ(held_out_choice(front, 2, table, rows.target, {}, nine_times), 2U);
  EXPECT_EQ(asked, 10);  // of 15 fits: 3 formulas, 5 folds
  EXPECT_FALSE(plain_sum_instead(front[2], table, rows.target, {}, [] { return false; }));
}

TEST(HeldOutChoice, LeavesAChoiceThatIsHardlyWorse) {
  EXPECT_EQ(Rows(60).choice_of({"0.5", "2*v", "2*v + 0.1*v^2"}, 2), 2U);
  EXPECT_EQ(Rows(60).choice_of({"2*v"}, 0), 0U);
}

TEST(HeldOutChoice, ChargesAFormForItsLengthTheMoreTheFewerTheRows) {
  // The same function, written at length: on ten rows a search finds so much for noise.
  const std::string length = "2*sgn(v)*abs(abs(abs(abs(abs(abs(abs(abs(abs(v)))))))))";
  EXPECT_EQ(Rows(12).choice_of({"0.5", "2*v", length}, 2), 1U);
  EXPECT_EQ(Rows(100).choice_of({"0.5", "2*v", length}, 2), 2U);
}

// The last number of the long form is what a single row says, and no other row speaks of it: a fold
// without that row keeps it, and would find nothing wrong there.
TEST(HeldOutChoice, CreditsNoFormWithWhatOneRowAloneTells) {
  Rows rows(14);
  rows.v.back() = 5;
  rows.target.back() = 14;
  rows.column = rows.v.data();
  EXPECT_EQ(rows.choice_of({"0.5", "2.6*v", "2*v + 4*exp(-400*(v - 5)^2)"}, 2), 1U);
}

TEST(HeldOutChoice, LeavesManyRowsToTheMethods) {
  EXPECT_EQ(Rows(401).choice_of({"0.5", "2*v"}, 0), 0U);
  EXPECT_EQ(Rows(400).choice_of({"0.5", "2*v"}, 0), 1U);
}

TEST(PlainSumInstead, TakesThePlaceOfWhatASearchFoundInFewNoisyRows) {
  const Rows rows(30, 1.0);
  const Inputs table{{&rows.column, 1}, rows.v.size()};
  const auto sum = plain_sum_instead(parse(kWild, kNames), table, rows.target, {});
  ASSERT_TRUE(sum);
  EXPECT_EQ(columns_used(*sum), 1U) << print(*sum, kNames);
  const std::vector<double> noise = [] {
    std::vector<double> values;
    RandomStream random(3);
    for (int r = 0; r < 30; ++r) values.push_back(random.normal());
    return values;
  }();
  const Expression wave = parse("3*sin(9*v)", kNames);
  const auto plain = plain_sum_instead(wave, table, noise, {});
  ASSERT_TRUE(plain);
  const std::vector<double> none(30, 0.0);
  EXPECT_LT(Evaluator().sum_squared_errors(*plain, table, none).sum, 10)
      << print(*plain, kNames) << " of noise";
}

TEST(PlainSumInstead, LeavesAFormThatTheRowsSpeakForAndManyRows) {
  Rows rows(60, 0.05);
  for (std::size_t r = 0; r < rows.v.size(); ++r) rows.target[r] += 3 * rows.v[r] * rows.v[r];
  const Inputs table{{&rows.column, 1}, rows.v.size()};
  EXPECT_FALSE(plain_sum_instead(parse("2*v + 3*v^2", kNames), table, rows.target, {}));
  const Rows many(401);
  EXPECT_FALSE(
      plain_sum_instead(parse("3*sin(9*v)", kNames), {{&many.column, 1}, 401}, many.target, {}));
}

// As solving the normal equations says, and with as many inputs as there are.
TEST(LinearSum, IsTheLeastSquaresLineOfTheInputsThatSaySomething) {
  RandomStream random(11);
  std::vector<std::vector<double>> columns(6);
  std::vector<const double*> pointers;
  std::vector<double> target;
  for (int r = 0; r < 80; ++r) {
    for (auto& column : columns) column.push_back(random.normal());
    columns[1].back() += columns[0].back();
    target.push_back(1 + 2 * columns[1].back() - 3 * columns[4].back() + 0.5 * columns[0].back() +
                     1e-9 * random.normal());
  }
  for (const auto& column : columns) pointers.push_back(column.data());
  const Inputs table{pointers, target.size()};
  const LinearSum sum = fit_linear_sum(table, target, {});
  EXPECT_LT(sum.held_out, 1e-16);
  EXPECT_LT(Evaluator().sum_squared_errors(sum.formula, table, target).sum, 1e-15);
}

}  // namespace
}  // namespace tribench::held_out_choice_test
