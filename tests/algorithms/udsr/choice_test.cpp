// SPDX-License-Identifier: MIT
#include "algorithms/udsr/choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "algorithms/admission.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench::udsr {
namespace {

// Twenty rows of x^y on the unit square, with noise or without.
struct Power {
  std::vector<double> x, y, target;
  std::vector<int> movement = std::vector<int>(20);
  std::vector<const double*> columns;
  std::vector<Input> inputs = {{"x", "-", Role::none, 0, 1, std::nullopt},
                               {"y", "-", Role::none, 0, 1, std::nullopt}};
  TokenLibrary library{find_operator_set("koza"), 2, {.constants = false, .linear = true}};

  explicit Power(double noise) {
    RandomStream random(4);
    for (int r = 0; r < 20; ++r) {
      x.push_back(random.uniform(0.05, 0.95));
      y.push_back(random.uniform(0.05, 0.95));
      target.push_back(std::pow(x.back(), y.back()) + noise * random.normal());
    }
    std::iota(movement.begin(), movement.end(), 0);
    columns = {x.data(), y.data()};
  }
};

std::size_t chosen(const Power& power, const std::vector<Expression>& front) {
  const ScoringProblem problem({power.inputs, power.columns, power.target, power.movement},
                               power.library, 3);
  std::vector<Candidate> pool;
  Scorer scorer(problem);
  for (const Expression& formula : front) pool.push_back({formula, scorer.nrmse(formula)});
  Budget budget({1'000'000'000, INFINITY});
  return choose_sound(Choice::posterior, front, pool, problem, input_box(power.inputs), budget);
}

TEST(Choice, TakesTheLawThatIsExactThoughItIsSingularWhereTheBoxEnds) {
  const std::vector<std::string> names = {"x", "y"};
  const std::vector<Expression> front = {parse("1 - 0.5*y", names), parse("exp(log(x)*y)", names)};
  const Power exact(0);
  ASSERT_EQ(prove_free(front[1], input_box(exact.inputs)).verdict, Verdict::refuted);
  EXPECT_EQ(chosen(exact, front), 1U);
  EXPECT_EQ(chosen(Power(0.01), front), 0U);
}

}  // namespace
}  // namespace tribench::udsr
