// SPDX-License-Identifier: MIT
#include "algorithms/parfam/family.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench::parfam {
namespace {

TEST(Monomials, AreAllTuplesOfTotalDegreeWithinTheCaps) {
  const std::vector<int> caps = {3, 1};
  const std::vector<Monomial> expected = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}};
  EXPECT_EQ(monomials_up_to(2, caps), expected);
}

TEST(Monomials, OfDegreeThreeCountAsBinomials) {
  // C(n + 3, 3) for n = 1 .. 5 where no cap bites.
  const std::size_t counts[] = {4, 10, 20, 35, 56};
  for (std::size_t n = 1; n <= 5; ++n) {
    const std::vector<int> caps(n, 3);
    EXPECT_EQ(monomials_up_to(3, caps).size(), counts[n - 1]);
  }
}

struct CountCase {
  int in, in_den, out, out_den;
  std::size_t counts[3];  // for 1, 2 and 4 inputs
};

TEST(Family, HasThePublishedNumberOfParameters) {
  for (const CountCase& c :
       {CountCase{1, 0, 1, 0, {5, 7, 11}}, CountCase{2, 0, 2, 0, {8, 15, 35}},
        CountCase{2, 1, 2, 1, {13, 22, 46}}, CountCase{2, 2, 4, 3, {21, 51, 181}}}) {
    const std::size_t inputs[] = {1, 2, 4};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::vector<int> caps(inputs[i], kMaximalPotence);
      const Family family{c.in, c.in_den, c.out, c.out_den, {Op::exp}, false};
      EXPECT_EQ(make_structure(family, caps).parameters(), c.counts[i])
          << describe(family) << " of " << inputs[i];
    }
  }
}

TEST(Family, ItsParametersAreCountedWithoutMakingThem) {
  for (Family family : {Family{0, 0, 3, 2, {}, false}, Family{2, 2, 4, 3, {Op::exp}, false},
                        Family{1, 1, 2, 0, {Op::cos, Op::sqrt}, false}}) {
    for (const bool enforce : {false, true}) {
      family.enforce_function = enforce;
      const std::vector<int> caps = {3, 1, 2};
      EXPECT_EQ(parameter_count(family, caps),
                static_cast<double>(make_structure(family, caps).parameters()))
          << describe(family);
    }
  }
  const std::vector<int> many(20'000, 3);
  EXPECT_EQ(parameter_count({0, 0, 2, 0, {}, false}, many), 20'001.0 * 20'002 / 2);
}

TEST(Family, EnforceKeepsOnlyMonomialsWithAFunction) {
  const std::vector<int> caps = {3};
  const Structure structure = make_structure({1, 0, 2, 0, {Op::exp}, true}, caps);
  // 1, x, g, x^2, x g  ->  g, x g
  EXPECT_EQ(structure.out_numerator, (std::vector<Monomial>{{0, 1}, {1, 1}}));
}

TEST(Family, IsReadFromItsText) {
  EXPECT_EQ(parse_family("2/0 exp 2/1"), (Family{2, 1, 2, 0, {Op::exp}, false}));
  EXPECT_EQ(parse_family("1/1 cos,sqrt 1/0"), (Family{1, 0, 1, 1, {Op::cos, Op::sqrt}, false}));
  EXPECT_EQ(parse_family("3/0"), (Family{0, 0, 3, 0, {}, false}));
  for (const char* text : {"", "3", "3/0 exp", "2/0 gamma 2/0", "2/0 exp 2/0 1", "a/0"}) {
    EXPECT_THROW(parse_family(text), Error) << text;
  }
}

TEST(Family, IsWithinTheOperatorsThatItNeeds) {
  EXPECT_TRUE(is_within(parse_family("2/0 exp 2/0"), find_operator_set("paper")));
  EXPECT_FALSE(is_within(parse_family("2/1 exp 2/0"), find_operator_set("paper")));
  EXPECT_FALSE(is_within(parse_family("2/0 cos 2/0"), find_operator_set("paper+div")));
}

TEST(Grid, HasThePublishedSizes) {
  EXPECT_EQ(published_grid(small_grid()).size(), 51U);
  EXPECT_EQ(published_grid(big_grid()).size(), 589U);
  // The reference paper's: no division, exp and sqrt.
  EXPECT_EQ(published_grid({2, 0, 2, 0, 1, {Op::exp, Op::sqrt}, false}).size(), 9U);
}

TEST(Grid, GoesFromCheapToExpensive) {
  const std::vector<Family> grid = published_grid(small_grid());
  EXPECT_EQ(grid[0], (Family{0, 0, 2, 0, {}, false}));
  EXPECT_EQ(grid[1], (Family{0, 0, 1, 1, {}, false}));
  EXPECT_EQ(grid[2], (Family{0, 0, 2, 1, {}, false}));
  EXPECT_EQ(grid[3], (Family{1, 0, 1, 0, {Op::sqrt}, false}));
  EXPECT_EQ(grid[4], (Family{1, 0, 1, 0, {Op::cos}, false}));
  EXPECT_EQ(grid[6], (Family{2, 0, 1, 0, {Op::sqrt}, false}));
  EXPECT_EQ(grid.back(), (Family{2, 1, 2, 1, {Op::exp}, false}));
}

TEST(PolynomialFormula, TakesOutCommonFactors) {
  const std::vector<std::string> names = {"v", "s"};
  const std::vector<Expression> variables = {Expression::variable(0), Expression::variable(1)};
  const std::vector<Monomial> monomials = {{0, 0}, {1, 0}, {0, 1}, {4, 1}, {1, 1}};
  const std::vector<double> coefficients = {-0.5, 12, 8, -4, 0};
  const Expression formula = polynomial_formula(monomials, coefficients, variables);
  EXPECT_EQ(paper_complexity(formula), 10) << print(formula, names);
  EXPECT_EQ(print(formula, names), "-0.5 + 12*v + s*(8 + -4*v^4)");
}

}  // namespace
}  // namespace tribench::parfam
