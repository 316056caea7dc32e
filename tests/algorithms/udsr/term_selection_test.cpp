// SPDX-License-Identifier: MIT
#include "algorithms/udsr/term_selection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "algorithms/expression/operator_set.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/udsr/linear_token.hpp"
#include "algorithms/udsr/pruning.hpp"
#include "foundation/pivoted_qr.hpp"
#include "foundation/random.hpp"

namespace tribench::udsr {
namespace {

// Rows of a law over a velocity and its sign.
struct Rows {
  Rows(const std::string& law, std::size_t rows, double noise) {
    RandomStream random(7);
    for (std::size_t r = 0; r < rows; ++r) {
      v.push_back(-1 + 2 * (static_cast<double>(r) + 0.5) / static_cast<double>(rows));
      s.push_back(v.back() > 0 ? 1 : -1);
      movement.push_back(static_cast<int>(r));
    }
    y.resize(rows);
    Evaluator().evaluate(parse(law, names), {columns(), rows}, y);
    for (double& value : y) value += noise * random.normal();
    inputs[1].sign_of = 0;
    problem.emplace(TrainingData{inputs, columns(), y, movement}, library, 3);
  }
  const std::vector<const double*>& columns() {
    pointers = {v.data(), s.data()};
    return pointers;
  }

  std::vector<std::string> names = {"v", "s"};
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1, 1, {}},
                               {"s", "-", Role::velocity_sign, -1, 1, {}}};
  std::vector<double> v, s, y;
  std::vector<int> movement;
  std::vector<const double*> pointers;
  TokenLibrary library{find_operator_set("paper"), 2, {true, true}};
  std::optional<ScoringProblem> problem;
};

TEST(MonomialCount, IsThatOfTheMonomials) {
  for (const std::vector<int>& caps :
       {std::vector<int>{3}, {3, 1, 2}, {0, 4, 4}, {6, 6, 1, 1}, {2, 2, 2, 2, 2}}) {
    for (int degree = 0; degree <= 6; ++degree) {
      EXPECT_EQ(monomial_count(caps, degree), static_cast<double>(monomials(caps, degree).size()));
    }
  }
}

// Fifty inputs and 47 rows: neither memory nor more coefficients than rows could tell.
TEST(AffordableDegree, FallsWithInputsAndRows) {
  const Input input{"x", "", Role::none, -1, 1, {}};
  EXPECT_EQ(affordable_degree(std::vector<Input>(2, input), 3, 20), 3);  // 10 terms
  EXPECT_EQ(affordable_degree(std::vector<Input>(13, input), 3, 47), 1);
  EXPECT_EQ(affordable_degree(std::vector<Input>(50, input), 3, 500), 1);
  EXPECT_EQ(affordable_degree(std::vector<Input>(10, input), 3, 31'000), 3);
  EXPECT_TRUE(wide_terms(std::vector<Input>(50, input), 6, 500).size() <= 500);
}

TEST(WideTerms, AreAPolynomialOfItsOwnOnEitherSideOfZeroWithFiveRowsATerm) {
  const Rows rows("v", 90, 0);
  EXPECT_EQ(wide_terms(rows.inputs, 6, 90).size(), 14U);
  EXPECT_EQ(wide_terms(rows.inputs, 6, 20).size(), 4U);
  EXPECT_TRUE(wide_terms(rows.inputs, 6, 9).empty());
  const std::vector<Monomial> terms = wide_terms(rows.inputs, 4, 90);
  EXPECT_NE(std::ranges::find(terms, Monomial{4, 1}), terms.end());
}

TEST(SelectTerms, PutsTheTermsThatMadeTheDataFirst) {
  const Rows rows("6*s - 0.5 + 3*v - 2*v^4*s", 90, 0.003);
  Budget budget({});
  const std::vector<Expression> found =
      select_terms(wide_terms(rows.inputs, 6, 90), *rows.problem, budget);
  ASSERT_FALSE(found.empty());
  EXPECT_LE(found.size(), 100U);
  EXPECT_GT(budget.spent(), 0U);
  const std::string first = print(found.front(), rows.names);
  EXPECT_NE(first.find("v^4*s"), std::string::npos) << first;
  EXPECT_EQ(movable_constants(found.front()).size(), 4U) << first;
  const std::vector<double> at = {0.5, 1};
  EXPECT_NEAR(Evaluator().evaluate_at(found.front(), at), 6 - 0.5 + 1.5 - 0.125, 0.005);
}

TEST(SelectTerms, FindsTheBestOfAllSubsets) {
  const Rows rows("exp(v)*s + 0.3*v", 60, 0.05);
  const std::vector<Monomial> terms = wide_terms(rows.inputs, 4, 60);
  ASSERT_EQ(terms.size(), 10U);
  Budget budget({});
  const std::vector<Expression> found = select_terms(terms, *rows.problem, budget);
  const auto n = static_cast<double>(rows.y.size());
  double best = std::numeric_limits<double>::infinity();
  for (unsigned chosen = 1; chosen < 1U << terms.size(); ++chosen) {
    const auto size = static_cast<Eigen::Index>(std::popcount(chosen));
    Eigen::MatrixXd design(rows.y.size(), size);
    Eigen::Index next = 0;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if ((chosen >> k & 1U) == 0) continue;
      design.col(next++) = column_of(terms[k], rows.pointers, rows.y.size());
    }
    const Eigen::Map<const Eigen::VectorXd> y(rows.y.data(), design.rows());
    const Eigen::VectorXd fitted = design * PivotedQr(design).solve(y);
    best = std::min(best, 0.5 * n * std::log((y - fitted).squaredNorm()) +
                              0.5 * static_cast<double>(size) * std::log(n));
  }
  std::vector<double> values(rows.y.size());
  Evaluator().evaluate(found.front(), rows.problem->inputs(), values);
  double sum = 0;
  for (std::size_t r = 0; r < values.size(); ++r) sum += std::pow(values[r] - rows.y[r], 2);
  const auto size = static_cast<double>(movable_constants(found.front()).size());
  EXPECT_NEAR(0.5 * n * std::log(sum) + 0.5 * size * std::log(n), best, 1e-6);
}

}  // namespace
}  // namespace tribench::udsr
