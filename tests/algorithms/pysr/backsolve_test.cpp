// SPDX-License-Identifier: MIT
#include "algorithms/pysr/backsolve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "algorithms/expression/text.hpp"
#include "algorithms/pysr/random_formula.hpp"
#include "algorithms/pysr/simplify.hpp"
#include "algorithms/pysr/tape_edit.hpp"
#include "algorithms/registry.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr::backsolve_test {
namespace {

const std::vector<std::string> kNames = {"x", "y"};

Expression formula(const char* text) { return parse(text, kNames); }

Rows rows_of(const char* law, std::size_t count = 60) {
  RandomStream random(4);
  std::vector<std::vector<double>> columns(2);
  for (std::size_t r = 0; r < count; ++r) {
    columns[0].push_back(random.uniform(-1, 1));
    columns[1].push_back(random.uniform(-1, 1));
  }
  Rows rows(std::move(columns), std::vector<double>(count));
  Evaluator().evaluate(formula(law), rows.inputs(), rows.target);
  return rows;
}

double mean_square(const Expression& f, const Rows& rows) {
  std::vector<double> values(rows.size());
  Evaluator().evaluate(f, rows.inputs(), values);
  double sum = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    sum += (values[r] - rows.target[r]) * (values[r] - rows.target[r]);
  }
  return sum / static_cast<double>(rows.size());
}

std::vector<Member> population(std::initializer_list<const char*> texts) {
  std::vector<Member> members;
  for (const char* text : texts) members.push_back({formula(text), 1, 1, 1, 0});
  return members;
}

TEST(Backsolve, AsksOfEverySubtreeWhatItIsWhereTheFormulaMeetsItsTarget) {
  RandomStream random(12);
  const OperatorSet& operators = find_operator_set("full");
  const Alphabet alphabet{operators, 2};
  Evaluator evaluator;
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    Rows rows = rows_of("x");
    const Expression f =
        random_formula_of_size(3 + static_cast<int>(random.below(12)), alphabet, random);
    evaluator.evaluate(f, rows.inputs(), rows.target);
    const std::size_t place = random.below(f.size());
    if (is_exponent(f, place)) continue;
    std::vector<double> actual(rows.size());
    evaluator.evaluate(subtree(f, place), rows.inputs(), actual);
    const Demand demand = demand_at(f, place, rows, evaluator);
    for (const std::size_t r : demand.rows) {
      if (!std::isfinite(rows.target[r])) continue;  // rows with such a target are in no search
      const double back = demand.values[r];
      // What a step on the way rounds away does not come back: compare what the formula makes of
      // it.
      const double here[] = {rows.columns[0][r], rows.columns[1][r]};
      const Expression solved = Expression::constant(back);
      const double there = evaluator.evaluate_at(with_replaced(f, place, solved.nodes()), here);
      EXPECT_NEAR(there, rows.target[r], 1e-6 * (1 + std::abs(rows.target[r])))
          << print(f, kNames) << " at " << print(subtree(f, place), kNames);
      compared += std::abs(back - actual[r]) < 1e-6 * (1 + std::abs(back)) ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(Backsolve, FindsWhatIsMissingInsideAnExponential) {
  const Rows rows = rows_of("exp(0.3 + 2*x - 0.5*(x*y))");
  const std::vector<Member> members = population({"x*y + 1", "exp(y)"});
  const Expression parent = formula("exp(x)");
  double best = mean_square(parent, rows);
  RandomStream random(1);
  for (int i = 0; i < 10; ++i) {
    Budget budget{BudgetLimits{}};
    const auto child = backsolve(parent, members, rows, 20, random, budget);
    ASSERT_TRUE(child.has_value());
    EXPECT_LE(child->size(), 20U);
    best = std::min(best, mean_square(*child, rows));
  }
  EXPECT_LT(best, 1e-20);
}

TEST(Backsolve, LeavesOutRowsWithoutAWayBack) {
  // The target is negative on half of the rows, where no exponent meets it.
  const Rows rows = rows_of("x");
  Evaluator evaluator;
  const Expression parent = formula("exp(y)");
  const Demand demand = demand_at(parent, 0, rows, evaluator);
  EXPECT_GT(demand.rows.size(), 15U);
  EXPECT_LT(demand.rows.size(), 45U);
  for (const std::size_t r : demand.rows) {
    EXPECT_GT(rows.target[r], 0);
    EXPECT_NEAR(demand.values[r], std::log(rows.target[r]), 1e-12);
  }
}

TEST(Backsolve, GivesNoCloneAndSpendsNothingItHasNot) {
  const Rows rows = rows_of("3*x + 1");
  const std::vector<Member> members = population({"x"});
  RandomStream random(2);
  Budget budget{BudgetLimits{}};
  for (int i = 0; i < 20; ++i) {
    const Expression parent = formula("0.5*x + 2");
    const auto child = backsolve(parent, members, rows, 12, random, budget);
    if (child) EXPECT_NE(structure_hash(simplified(*child)), structure_hash(simplified(parent)));
  }
  Budget none{BudgetLimits{.evaluations = 3}};
  EXPECT_FALSE(backsolve(formula("0.5*x + 2"), members, rows, 12, random, none).has_value());
  EXPECT_EQ(none.spent(), 0U);
  EXPECT_FALSE(backsolve(formula("x"), members, rows, 12, random, budget).has_value());
}

FitResult fit(const std::map<std::string, ParameterValue>& given, int threads) {
  const Rows rows = rows_of("exp(0.3 + 2*x - 0.5*(x*y))", 80);
  const std::vector<Input> inputs = {{"x", "-", Role::none, -1, 1, {}},
                                     {"y", "-", Role::none, -1, 1, {}}};
  const std::vector<int> movement(rows.size(), 0);
  const TrainingData data{inputs, rows.pointers, rows.target, movement};
  Budget budget{BudgetLimits{}};
  FitContext context{data, find_operator_set("paper"), budget, RandomStream(3), threads, nullptr};
  return Registry().make("pysr", given)->fit(context);
}

TEST(Backsolve, AndBurstsGiveTheSameBitsForAnyNumberOfThreads) {
  const std::map<std::string, ParameterValue> given = {
      {"profile", std::string("v2")},
      {"iterations", std::int64_t{3}},
      {"populations", std::int64_t{3}},
      {"cycles", std::int64_t{30}},
      {"mutation_weights", std::string("backsolve=2; rotate_tree=1")},
      {"mutation_burst", true}};
  const FitResult one = fit(given, 1);
  EXPECT_EQ(one.front, fit(given, 4).front);
  auto without = given;
  without.erase("mutation_weights");
  EXPECT_NE(one.front, fit(without, 1).front);
}

TEST(MutationWeights, SayWhatTheyDoNotUnderstand) {
  const Registry registry;
  for (const char* text : {"backsolv=1", "backsolve", "grow=-1", "grow=x", "grow=nan"}) {
    EXPECT_THROW(registry.make("pysr", {{"mutation_weights", std::string(text)}}), Error) << text;
  }
}

}  // namespace
}  // namespace tribench::pysr::backsolve_test
