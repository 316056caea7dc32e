// SPDX-License-Identifier: MIT
#include "algorithms/fitting/posterior_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "foundation/random.hpp"

namespace tribench::posterior_choice_test {
namespace {

const std::vector<std::string> kNames = {"v"};

struct Fixture {
  std::vector<double> v;
  std::vector<const double*> columns;
  Fixture() {
    for (int r = 0; r < 50; ++r) v.push_back(-1 + r / 24.5);
    columns = {v.data()};
  }
  Inputs inputs() const { return {columns, v.size()}; }
};

std::vector<Expression> formulas(const std::vector<const char*>& texts) {
  std::vector<Expression> result;
  for (const char* text : texts) result.push_back(parse(text, kNames));
  return result;
}

TEST(PosteriorChoice, IsNearTheMeanOfWhatIsEquallyLikely) {
  const Fixture f;
  const std::vector<Expression> all = formulas({"v", "3*v", "1.9*v"});
  const std::vector<WeighedFormula> pool = {
      {&all[0], 0, 1e-3}, {&all[1], 0, 1e-3}, {&all[2], 2, 1e-3}};
  const std::vector<double> distance =
      distances_from_posterior_mean(all, pool, f.inputs()).mean_square;
  // Mean slope (1 + 3 + 1.9 e^-2) / (2 + e^-2), mean of v^2 over the rows.
  const double slope = (4 + 1.9 * std::exp(-2.0)) / (2 + std::exp(-2.0));
  double square = 0;
  for (const double v : f.v) square += v * v / 50;
  EXPECT_NEAR(distance[0], (1 - slope) * (1 - slope) * square, 1e-12);
  EXPECT_NEAR(distance[2], (1.9 - slope) * (1.9 - slope) * square, 1e-12);
  EXPECT_LT(distance[2], distance[0]);
}

TEST(PosteriorChoice, CountsAFunctionOnceHoweverOftenItIsWritten) {
  const Fixture f;
  const std::vector<Expression> all = formulas({"v", "3*v", "v + 0", "1*v", "v*1 + 0*v"});
  std::vector<WeighedFormula> pool = {{&all[0], 0, 1e-3}, {&all[1], 0, 1e-3}};
  const std::vector<double> once = distances_from_posterior_mean(all, pool, f.inputs()).mean_square;
  for (std::size_t k = 2; k < all.size(); ++k) pool.push_back({&all[k], 0, 1e-3});
  EXPECT_EQ(once, distances_from_posterior_mean(all, pool, f.inputs()).mean_square);
}

TEST(PosteriorChoice, AsksOnlyWhatHasEvidenceAndIsFinite) {
  const Fixture f;
  const std::vector<Expression> all = formulas({"v", "9*v", "log(v)"});
  const std::vector<WeighedFormula> pool = {
      {&all[0], 0, 1e-3}, {&all[1], 40, 1e-3}, {&all[2], -5, 1e-3}};
  const std::vector<double> distance =
      distances_from_posterior_mean(all, pool, f.inputs()).mean_square;
  EXPECT_NEAR(distance[0], 0, 1e-25);
  EXPECT_TRUE(std::isinf(distance[2]));
  EXPECT_TRUE(std::isinf(distances_from_posterior_mean(all, {}, f.inputs()).mean_square[0]));
}

TEST(PosteriorChoice, TakesTheSimplestThatIsTypicalAndTheNearestWhereNoneIs) {
  EXPECT_EQ(simplest_typical({{9, 2, 1, 3}, 2, 0}), 1U);
  EXPECT_EQ(simplest_typical({{9, 2, 1, 3}, 0.5, 0}), 2U);
}

TEST(PosteriorChoice, SpreadsAsFarAsItsFormsLieFromTheirMean) {
  const Fixture f;
  const std::vector<Expression> all = formulas({"v", "3*v"});
  const std::vector<WeighedFormula> pool = {{&all[0], 0, 1e-3}, {&all[1], 0, 1e-3}};
  const PosteriorDistances distances = distances_from_posterior_mean(all, pool, f.inputs());
  EXPECT_NEAR(distances.spread, distances.mean_square[0], 1e-12);
}

TEST(Evidence, ChargesNumbersAndNodesByHand) {
  const Expression line = parse("2*v + 1", kNames);  // two numbers, five nodes
  const double n = 100;
  EXPECT_NEAR(evidence_price(line, 100), std::log(n) + 2.5, 1e-12);
  EXPECT_NEAR(evidence_price(line, 100, 0), std::log(n), 1e-12);
  EXPECT_NEAR(evidence_against(line, 0.01, 1, 100) - evidence_against(line, 0.04, 1, 100),
              -50 * std::log(4.0), 1e-9);
  // What is exact is not better for being more exact.
  EXPECT_EQ(evidence_against(line, 1e-40, 1, 100), evidence_against(line, 0, 1, 100));
}

}  // namespace
}  // namespace tribench::posterior_choice_test
