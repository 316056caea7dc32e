// SPDX-License-Identifier: MIT
#include "algorithms/udsr/linear_token.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "algorithms/expression/text.hpp"
#include "algorithms/udsr/pruning.hpp"
#include "algorithms/udsr/scoring.hpp"
#include "tests/algorithms/udsr/tokens.hpp"

namespace tribench::udsr {
namespace {

TEST(Monomials, CountsAreThoseOfThePublishedToken) {
  for (const auto& [inputs, count] : {std::pair{1, 4}, {2, 10}, {3, 20}, {4, 35}, {5, 56}}) {
    const std::vector<int> caps(static_cast<std::size_t>(inputs), 3);
    EXPECT_EQ(monomials(caps, 3).size(), static_cast<std::size_t>(count));
  }
  const std::vector<int> with_sign = {3, 1};
  EXPECT_EQ(monomials(with_sign, 3).size(), 7U);  // 1 v s v^2 vs v^3 v^2 s
}

// A problem over v in [0.2, 2] and w in [-1, 1] with a given law.
class LinearTokenTest : public testing::Test {
 protected:
  void make(const char* law) {
    const std::vector<std::string> names = {"v", "w"};
    const Expression truth = parse(law, names);
    RandomStream random(11);
    Evaluator evaluator;
    v.clear();
    w.clear();
    y.clear();
    for (int i = 0; i < 120; ++i) {
      v.push_back(random.uniform(0.2, 2));
      w.push_back(random.uniform(-1, 1));
      const std::vector<double> point = {v.back(), w.back()};
      y.push_back(evaluator.evaluate_at(truth, point));
    }
    pose(3);
  }
  void pose(int degree) {
    columns = {v.data(), w.data()};
    problem.emplace(TrainingData{inputs, columns, y, {}}, library, degree);
  }
  double error_of(std::initializer_list<std::string_view> names) {
    const Scored scored = Scorer(*problem).score(sequence_of(library, names));
    return scored.reward > 0 ? scored.nrmse : INFINITY;
  }

  TokenLibrary library{find_operator_set("full"), 2, {.constants = true, .linear = true}};
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, 0.2, 2, std::nullopt},
                               {"w", "-", Role::none, -1, 1, std::nullopt}};
  std::vector<double> v, w, y;
  std::vector<const double*> columns;
  std::optional<ScoringProblem> problem;
};

TEST_F(LinearTokenTest, RecoversAPolynomialExactly) {
  make("1.5 - 2*v + 0.25*v^2*w - w^3");
  EXPECT_LT(error_of({"linear"}), 1e-8);
}

TEST_F(LinearTokenTest, RecoversThroughEveryInvertibleFunction) {
  make("log(1 + v^2 + 0.5*w^2)");
  EXPECT_LT(error_of({"log", "linear"}), 1e-8);
  make("exp(0.3*v - w)");
  EXPECT_LT(error_of({"exp", "linear"}), 1e-8);
  make("sqrt(2 + v*w + v^3)");
  EXPECT_LT(error_of({"sqrt", "linear"}), 1e-8);
  make("tanh(0.2*v + 0.3*w)");
  EXPECT_LT(error_of({"tanh", "linear"}), 1e-8);
}

TEST_F(LinearTokenTest, RecoversOnEitherSideOfEveryOperation) {
  make("(1 + v*w)*exp(v) + sin(w)");
  EXPECT_LT(error_of({"+", "*", "linear", "exp", "x1", "sin", "x2"}), 1e-8);
  make("exp(w) - (2 - v^3)/v");
  EXPECT_LT(error_of({"-", "exp", "x2", "/", "linear", "x1"}), 1e-8);
  make("v/(3 + w^2) - w");
  EXPECT_LT(error_of({"-", "/", "x1", "linear", "x2"}), 1e-8);
}

TEST_F(LinearTokenTest, MinimisesTheFormulasOwnErrorAndNotThatOfTheInvertedTarget) {
  // Noise of equal size in y is of very unequal size in log y.
  make("exp(2*v - 1)");
  RandomStream noise(5);
  for (double& value : y) value = std::max(0.01, value + 0.5 * noise.normal());
  pose(1);
  Eigen::VectorXd log_y(static_cast<Eigen::Index>(y.size()));
  for (std::size_t i = 0; i < y.size(); ++i) log_y[static_cast<Eigen::Index>(i)] = std::log(y[i]);
  const Eigen::VectorXd plain = problem->linear().solve(log_y, {});
  const std::span<const double> coefficients(plain.data(), static_cast<std::size_t>(plain.size()));
  const Expression inverted_fit =
      Expression::unary(Op::exp, polynomial(problem->linear().terms(), coefficients));
  EXPECT_LT(error_of({"exp", "linear"}), 0.9 * Scorer(*problem).nrmse(inverted_fit));
}

TEST_F(LinearTokenTest, CannotBeInvertedWhereTheTargetLeavesTheRange) {
  make("v - 1");  // negative for half of the rows
  EXPECT_EQ(error_of({"exp", "linear"}), INFINITY);
}

TEST_F(LinearTokenTest, PruningEndsAtTheTermsThatMadeTheData) {
  make("3*v - 2*v*w");
  const Scored full = Scorer(*problem).score(sequence_of(library, {"linear"}));
  Budget budget{{}};
  const std::vector<Pruner::Step> path = Pruner(*problem).path(full.formula, 1, budget, budget);
  ASSERT_GE(path.size(), 2U);
  const Pruner::Step& two = path[path.size() - 2];
  EXPECT_LT(two.nrmse, 1e-9);
  EXPECT_GT(path.back().nrmse, 0.1);
  const std::vector<std::string> names = {"v", "w"};
  EXPECT_EQ(constant_positions(two.formula).size(), 2U) << print(two.formula, names);
  EXPECT_GT(budget.spent(), 0U);
}

TEST_F(LinearTokenTest, PruningMovesTheScalesInsideFunctions) {
  make("(1 + 2*v)*exp(0.7*w - 0.3*v^2)");
  // The sequence has no place for 0.7 and 0.3.
  const Scored scored = Scorer(*problem).score(
      sequence_of(library, {"*", "linear", "exp", "-", "x2", "*", "x1", "x1"}));
  ASSERT_GT(scored.nrmse, 1e-4);
  Budget budget{{}};
  double best = 1;
  for (const Pruner::Step& step :
       Pruner(*problem).path(with_constants(scored.formula), 4, budget, budget)) {
    if (constant_positions(step.formula).size() <= 6) best = std::min(best, step.nrmse);
  }
  EXPECT_LT(best, 1e-6);
}

TEST(WithConstants, ScalesTermsAndShiftsSumsOnceAndChangesNoValue) {
  const std::vector<std::string> names = {"v", "w"};
  EXPECT_EQ(print(with_constants(parse("v + exp(v*w - w^2)", names)), names),
            "v*1 + exp(v*w*1 - w^2*1)*1 + 0");
  EXPECT_EQ(print(with_constants(parse("2*v + sqrt(3*w)*4", names)), names),
            "2*v + sqrt(3*w)*4 + 0");
}

TEST(WithoutTerm, KeepsWhatIsLeftOfADifference) {
  const std::vector<std::string> names = {"v", "w"};
  const auto without = [&](const char* text, std::size_t place) {
    return print(without_term(parse(text, names), place), names);
  };
  EXPECT_EQ(without("2*v + 3*w", 2), "3*w");
  EXPECT_EQ(without("2*v - 3*w", 5), "2*v");
  EXPECT_EQ(without("2*v - 3*w", 2), "-1*(3*w)");
}

}  // namespace
}  // namespace tribench::udsr
