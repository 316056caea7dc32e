#include "algorithms/fitting/cross_validation.hpp"

#include <gtest/gtest.h>

#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench {
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

TEST(CrossValidation, TakesTheLastFormulaWhereThereIsNothingToHoldOut) {
  const std::vector<double> v = {1, 2, 3};
  const std::vector<double> y = {1, 2, 3};
  const std::vector<int> movement = {0, 0, 0};
  const double* columns[] = {v.data()};
  const std::vector<Expression> front = {parse("2", kNames), parse("1*v", kNames)};
  EXPECT_EQ(cross_validate(front, {columns, 3}, y, movement).chosen, 1U);
}

}  // namespace
}  // namespace tribench
