// SPDX-License-Identifier: MIT
#include "algorithms/fitting/cross_validation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench::cross_validation_test {
namespace {

const std::vector<std::string> kNames = {"v"};

struct Line {
  std::vector<double> v;
  std::vector<double> y;
  std::vector<int> movement;
};

// 20 movements of 5 rows on 1 + 2 v; noise of sd 0.1 common to a movement.
Line noisy_line() {
  RandomStream random(3);
  Line line;
  for (int m = 0; m < 20; ++m) {
    const double offset = 0.1 * random.normal();
    for (int i = 0; i < 5; ++i) {
      line.v.push_back(random.uniform(-1, 1));
      line.y.push_back(1 + 2 * line.v.back() + offset);
      line.movement.push_back(m);
    }
  }
  return line;
}

TEST(CrossValidation, ChoosesTheFormThatMadeTheDataOverSmallerAndLargerOnes) {
  const Line line = noisy_line();
  const double* columns[] = {line.v.data()};
  const std::vector<Expression> front = {
      parse("1", kNames), parse("1 + 1*v", kNames), parse("1 + v + 0.1*v^2 + 0.1*v^3", kNames),
      parse("1 + v + 0.1*v^2 + 0.1*v^3 + 0.1*v^4 + 0.1*v^5 + 0.1*v^6", kNames)};
  const CrossValidation result = cross_validate(front, {columns, 100}, line.y, line.movement);
  EXPECT_EQ(result.chosen, 1U);
  EXPECT_GT(result.mean_square[0], 50 * result.mean_square[1]);
  EXPECT_GT(result.node_rows, 0U);
}

TEST(CrossValidation, HoldsOutWholeMovements) {
  // The target is a level of its own in every movement: within a movement it is known, for a new
  // one it is not. Holding out rows would let the wiggly formula look good.
  RandomStream random(4);
  std::vector<double> v;
  std::vector<double> y;
  std::vector<int> movement;
  for (int m = 0; m < 12; ++m) {
    const double level = random.normal();
    for (int i = 0; i < 20; ++i) {
      v.push_back(m / 12.0 + 1e-3 * random.uniform());
      y.push_back(level);
      movement.push_back(m);
    }
  }
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {
      parse("0.5", kNames), parse("1 + v + v^2 + v^3 + v^4 + v^5 + v^6 + v^7 + v^8", kNames)};
  EXPECT_EQ(cross_validate(front, {columns, v.size()}, y, movement).chosen, 0U);
}

TEST(CrossValidation, HoldsOutStretchesOfASingleMovement) {
  // Ten levels in a row: each is known within its stretch and unknown for the next.
  RandomStream random(6);
  std::vector<double> v;
  std::vector<double> y;
  double level = 0;
  for (int i = 0; i < 200; ++i) {
    if (i % 20 == 0) level = random.normal();
    v.push_back(i / 20 + 1e-3 * random.uniform());
    y.push_back(level);
  }
  const std::vector<int> movement(200, 7);
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {
      parse("0.5", kNames), parse("1 + v + v^2 + v^3 + v^4 + v^5 + v^6 + v^7 + v^8", kNames)};
  EXPECT_EQ(cross_validate(front, {columns, v.size()}, y, movement).chosen, 0U);
}

TEST(CrossValidation, KnowsWhereTheBoxReachesBeyondTheRows) {
  const Line line = noisy_line();
  const std::vector<double> sign(100, 1.0);
  const double* columns[] = {line.v.data(), sign.data()};
  const Inputs inputs{columns, 100};
  EXPECT_FALSE(reaches_beyond(inputs, {}));
  EXPECT_FALSE(reaches_beyond(inputs, {{-1.02, 1.02}, {-1, 1, 0}}));
  EXPECT_TRUE(reaches_beyond(inputs, {{-1, 1.5}, {-1, 1, 0}}));
  EXPECT_TRUE(reaches_beyond(inputs, {{-1.5, 1}, {-1, 1, 0}}));
}

TEST(CrossValidation, RefusesAFormulaThatRunsAwayWhereTheBoxIsWiderThanTheRows) {
  // The second formula is the truth on the rows; where it will be used it comes to 1e10.
  RandomStream random(8);
  std::vector<double> v;
  std::vector<double> y;
  std::vector<int> movement;
  for (int r = 0; r < 200; ++r) {
    v.push_back(random.uniform(-1, 1));
    y.push_back(v.back() + 1e-9 * std::exp(20 * v.back()));
    movement.push_back(r / 20);
  }
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {parse("1*v", kNames),
                                         parse("1*v + 1e-9*exp(20*v)", kNames)};
  EXPECT_EQ(cross_validate(front, {columns, 200}, y, movement).chosen, 1U);
  EXPECT_EQ(cross_validate(front, {columns, 200}, y, movement, {{-1, 1}}).chosen, 1U);
  const CrossValidation beyond = cross_validate(front, {columns, 200}, y, movement, {{-1, 2.2}});
  EXPECT_EQ(beyond.chosen, 0U);
  EXPECT_TRUE(std::isinf(beyond.mean_square[1]));
}

TEST(CrossValidation, HoldsOutTheEdgeThatAFormulaWillBeContinuedOver) {
  // |v|: a polynomial of degree 6 follows its corner better than a parabola, and leaves it faster
  // where the rows end.
  std::vector<double> v;
  std::vector<double> y;
  std::vector<int> movement;
  for (int r = 0; r < 400; ++r) {
    v.push_back(-1 + 0.005 * r);
    y.push_back(std::abs(v.back()));
    movement.push_back(r % 10);
  }
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {parse("0.5 + 0.1*v", kNames),
                                         parse("0.1 + 0.1*v + 0.9*v^2", kNames),
                                         parse("0.1 + 0.1*v + 0.9*v^2 + 0.1*v^3 + 0.1*v^4 + "
                                               "0.1*v^5 + 0.1*v^6",
                                               kNames)};
  const auto last_over_parabola = [&](const InputBox& box) {
    const CrossValidation result = cross_validate(front, {columns, 400}, y, movement, box);
    return result.mean_square[2] / result.mean_square[1];
  };
  EXPECT_LT(last_over_parabola({}), 1);
  EXPECT_GT(last_over_parabola({{-1, 1.2}}), 1);
}

TEST(CrossValidation, ForgivesNoFormulaThatIsFarWorseInOnePart) {
  // The constant is wrong where the movement with the peak is held out and nowhere else, so that
  // the standard error of its mean is as large as the mean. The peak is exact; the third formula
  // is exact as well, and larger.
  std::vector<double> v;
  std::vector<double> y;
  std::vector<int> movement;
  for (int r = 0; r < 200; ++r) {
    v.push_back(-1 + 0.01 * r);
    y.push_back(1 / (1 + 100 * (v.back() - 0.4) * (v.back() - 0.4)));
    movement.push_back(r / 40);
  }
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {parse("0.1", kNames),
                                         parse("1.1/(1 + 99*(v - 0.4)^2)", kNames),
                                         parse("1.1/(1 + 99*(v - 0.4)^2) + 0.1*v", kNames)};
  EXPECT_EQ(cross_validate(front, {columns, 200}, y, movement, {{-1, 1.2}}).chosen, 1U);
}

TEST(CrossValidation, AsksMoreOfALargerFormulaThatWillBeUsedBeyondTheRows) {
  int within = 0;
  int beyond = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomStream random(100 + seed);
    std::vector<double> v;
    std::vector<double> y;
    std::vector<int> movement;
    for (int r = 0; r < 200; ++r) {
      v.push_back(random.uniform(-1, 1));
      y.push_back(v.back() + 0.15 * v.back() * v.back() + 0.5 * random.normal());
      movement.push_back(r / 20);
    }
    const double* columns[] = {v.data()};
    const std::vector<Expression> front = {parse("0.1 + 1*v", kNames),
                                           parse("0.1 + 1*v + 0.1*v^2", kNames)};
    within += cross_validate(front, {columns, 200}, y, movement).chosen == 1 ? 1 : 0;
    beyond += cross_validate(front, {columns, 200}, y, movement, {{-1, 1.2}}).chosen == 1 ? 1 : 0;
  }
  EXPECT_GT(within, 0);
  EXPECT_LT(2 * beyond, within) << beyond << " of " << within;
}

TEST(CrossValidation, TakesTheLastFormulaWhereThereIsNothingToHoldOut) {
  const std::vector<double> v = {1, 2, 3};
  const std::vector<double> y = {1, 2, 3};
  const std::vector<int> movement = {0, 0, 0};
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {parse("2", kNames), parse("1*v", kNames)};
  EXPECT_EQ(cross_validate(front, {columns, 3}, y, movement).chosen, 1U);
}

TEST(CrossValidation, DoesNotTrustAFormulaWithAsManyNumbersAsThereAreRowsToFit) {
  // Its constants come from all rows, and rows that are too few to move them leave it exact.
  const std::vector<double> v = {0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0};
  const std::string many = "1 + 0.1*v^7 + 0.2*v^6 - 0.3*v^5 + 0.2*v^4 + 0.1*v^3 - 0.5*v^2 + 1*v";
  std::vector<double> y(v.size());
  std::vector<int> movement(v.size());
  std::iota(movement.begin(), movement.end(), 0);
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {parse("1 + 1*v", kNames), parse(many, kNames)};
  Evaluator().evaluate(front[1], {columns, v.size()}, y);
  const CrossValidation result = cross_validate(front, {columns, v.size()}, y, movement);
  EXPECT_EQ(result.chosen, 0U);
  EXPECT_TRUE(std::isinf(result.mean_square[1]));
}

TEST(CrossValidation, TriesAFormulaOverTheStretchThatItWillBeContinuedOver) {
  // A straight line with noise: rows to 0.5 say little of a fourth power at 1.
  RandomStream random(31);
  std::vector<double> v;
  std::vector<double> y;
  std::vector<int> movement;
  for (int r = 0; r < 400; ++r) {
    v.push_back(random.uniform(-1, 1));
    y.push_back(v.back() + random.uniform(-0.3, 0.3));
    movement.push_back(r / 40);
  }
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {parse("1*v", kNames),
                                         parse("1*v + 0.1*v^2 + 0.1*v^3 + 0.1*v^4", kNames)};
  const auto worse = [&](double reach, Beyond beyond) {
    const auto& square =
        cross_validate(front, {columns, 400}, y, movement, {{-reach, reach}}, 5, {}, beyond)
            .mean_square;
    return square[1] / square[0] - 1;
  };
  EXPECT_GT(worse(2, Beyond::as_far), 3 * worse(2, Beyond::edges));
  EXPECT_GT(worse(2, Beyond::as_far), 3 * worse(1.2, Beyond::as_far));
  EXPECT_EQ(worse(1.2, Beyond::edges), worse(2, Beyond::edges));
}

}  // namespace
}  // namespace tribench::cross_validation_test
