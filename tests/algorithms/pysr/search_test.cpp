// SPDX-License-Identifier: MIT
//
// Whole searches: planted laws are found, options change what they say, results do not depend on
// threads, deadlines hold.
#include "algorithms/pysr/search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/pysr/units.hpp"
#include "algorithms/registry.hpp"

namespace tribench::pysr::search_test {
namespace {

const std::vector<std::string> kNames = {"v", "sgn_v"};

// s (6 + 2 exp(-5 |v|)) + 3 v with noise of 0.02 N m.
struct Stribeck {
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -2, 2, {}},
                               {"sgn_v", "-", Role::velocity_sign, -1, 1, 0}};
  std::vector<double> v;
  std::vector<double> s;
  std::vector<double> target;
  std::vector<double> truth;
  std::vector<int> movement;
  std::vector<const double*> pointers;

  explicit Stribeck(std::size_t rows = 120) {
    RandomStream random(key_of("stribeck"));
    for (std::size_t r = 0; r < rows; ++r) {
      v.push_back(-2 + 4 * (static_cast<double>(r) + 0.5) / static_cast<double>(rows));
      s.push_back(v[r] > 0 ? 1 : -1);
      truth.push_back(s[r] * (6 + 2 * std::exp(-5 * std::abs(v[r]))) + 3 * v[r]);
      target.push_back(truth[r] + 0.02 * random.normal());
      movement.push_back(static_cast<int>(r));
    }
    pointers = {v.data(), s.data()};
  }
  TrainingData data() const { return {inputs, pointers, target, movement}; }
};

class Trace : public Progress {
 public:
  void improved(double train_error, std::uint64_t evaluations) override {
    errors.push_back(train_error);
    spent.push_back(evaluations);
  }
  std::vector<double> errors;
  std::vector<std::uint64_t> spent;
};

using Given = std::map<std::string, ParameterValue>;

FitResult fit(const Stribeck& problem, const Given& given = {}, const BudgetLimits& limits = {},
              int threads = 1, Progress* progress = nullptr, const char* operators = "paper") {
  const Registry registry;
  const auto method = registry.make("pysr", given);
  const TrainingData data = problem.data();
  Budget budget(limits);
  FitContext context{data,    find_operator_set(operators), budget, RandomStream(11), threads,
                     progress};
  return method->fit(context);
}

double mean_error(const Expression& formula, const Stribeck& problem,
                  const std::vector<double>& against) {
  std::vector<double> values(against.size());
  Evaluator().evaluate(formula, problem.data().table(), values);
  double sum = 0;
  for (std::size_t r = 0; r < values.size(); ++r) sum += std::abs(values[r] - against[r]);
  return sum / static_cast<double>(values.size());
}

std::vector<std::string> texts(const FitResult& result) {
  std::vector<std::string> texts;
  for (const Expression& formula : result.front) texts.push_back(print(formula, kNames));
  return texts;
}

// v1 and v2 with so little effort that a test can afford them.
Given small(const char* profile) {
  return {{"profile", std::string(profile)},
          {"iterations", std::int64_t{4}},
          {"populations", std::int64_t{4}},
          {"cycles", std::int64_t{60}}};
}

TEST(Search, FindsAStribeckLawBelowItsNoise) {
  const Stribeck problem;
  const FitResult result = fit(problem);
  EXPECT_LT(mean_error(result.front[result.chosen], problem, problem.truth), 0.012);
  EXPECT_LE(result.front[result.chosen].size(), 24u);
  EXPECT_EQ(result.reason, StopReason::converged);
}

TEST(Search, PrintsFormulasThatReadBackWithTheSameErrorBitForBit) {
  const Stribeck problem;
  for (const Expression& formula : fit(problem).front) {
    const Expression read = parse(print(formula, kNames), kNames);
    EXPECT_EQ(mean_error(read, problem, problem.target),
              mean_error(formula, problem, problem.target));
  }
}

TEST(Search, GivesTheSameBitsForAnyNumberOfThreadsInEveryProfile) {
  const Stribeck problem;
  for (const char* profile : {"v1", "v2"}) {
    const std::vector<std::string> one = texts(fit(problem, small(profile)));
    EXPECT_EQ(texts(fit(problem, small(profile), {}, 2)), one) << profile;
    EXPECT_EQ(texts(fit(problem, small(profile), {}, 8)), one) << profile;
  }
}

TEST(Search, TracesAFallingErrorAgainstRisingEvaluations) {
  const Stribeck problem;
  Trace trace;
  fit(problem, small("v2"), {}, 1, &trace);
  ASSERT_GE(trace.errors.size(), 2u);
  for (std::size_t i = 1; i < trace.errors.size(); ++i) {
    EXPECT_LT(trace.errors[i], trace.errors[i - 1]);
    EXPECT_GT(trace.spent[i], trace.spent[i - 1]);
  }
}

TEST(Search, StartsFromFormulasThatAreGiven) {
  const Stribeck problem;
  Given given = small("v1");
  given["iterations"] = std::int64_t{1};
  given["cycles"] = std::int64_t{1};
  const double without = mean_error(fit(problem, given).front.back(), problem, problem.truth);
  given["guesses"] = std::string("sgn_v*(5 + 1*exp(-3*(v*sgn_v))) + 2*v; v");
  const double with = mean_error(fit(problem, given).front.back(), problem, problem.truth);
  EXPECT_LT(with, 0.02);
  EXPECT_GT(without, 0.05);
}

TEST(Search, ScoresOnBatchesWhereAskedTo) {
  const Stribeck problem(2000);
  Given given = small("v2");
  Trace plain;
  Trace batched;
  given["batching"] = std::string("off");
  fit(problem, given, {}, 1, &plain);
  given["batching"] = std::string("on");
  given["batch_size"] = std::int64_t{64};
  fit(problem, given, {}, 1, &batched);
  EXPECT_LT(batched.spent.back(), plain.spent.back() / 2);
}

TEST(Search, WarmsUpTheSizeThatIsAllowed) {
  const Stribeck problem;
  Given given = small("v1");
  given["warm_up"] = 1.0;
  given["iterations"] = std::int64_t{2};
  const std::size_t small_first = fit(problem, given).front.back().size();
  // Half way 3 + 27 / 2 = 16 nodes are allowed, at the start 3.
  EXPECT_LE(small_first, 16u);
}

TEST(Search, KeepsConstraintsInEveryFormulaOfTheFront) {
  const Stribeck problem;
  const FitResult result = fit(problem, {{"max_size", std::int64_t{15}},
                                         {"nested_limits", std::string("exp>exp=0; exp>sqrt=0")}});
  for (const Expression& formula : result.front) {
    EXPECT_LE(formula.size(), 15u);
    for (std::size_t i = 0; i < formula.size(); ++i) {
      if (formula.node(i).op != Op::exp) continue;
      const Expression argument = subtree(formula, i - 1);
      for (const Node& node : argument.nodes()) {
        EXPECT_NE(node.op, Op::exp);
        EXPECT_NE(node.op, Op::sqrt);
      }
    }
  }
}

TEST(Search, AdmitsOnlyWhatIsProvedFreeWhereTheSetAsksForIt) {
  const Stribeck problem;
  const FitResult result = fit(problem, {}, {}, 1, nullptr, "paper+safe_div");
  const InputBox box = {{-2, 2, {}}, {-1, 1, 0}};
  ASSERT_FALSE(result.front.empty());
  for (const Expression& formula : result.front) {
    EXPECT_EQ(prove_free(formula, box).verdict, Verdict::proved_free) << print(formula, kNames);
  }
}

TEST(Search, KeepsItsDeadlineInsideTheIslands) {
  const Stribeck problem(20'000);
  Given given = small("v1");
  given["iterations"] = std::int64_t{1000};
  BudgetLimits limits;
  limits.cpu_seconds = 0.3;
  const double start = process_cpu_seconds();
  const FitResult result = fit(problem, given, limits);
  EXPECT_LT(process_cpu_seconds() - start, 0.6);
  EXPECT_EQ(result.reason, StopReason::budget);
  EXPECT_FALSE(result.front.empty());
}

TEST(Search, RefusesInconsistentUnitsWhereTheyAreHard) {
  Stribeck problem;
  problem.inputs[0].unit = "m/s";
  Given given = small("v2");
  given["units"] = std::string("hard");
  given["target_unit"] = std::string("N");
  const FitResult result = fit(problem, given);
  const std::vector<Dimension> dimensions = {parse_unit("m/s"), parse_unit("-")};
  for (const Expression& formula : result.front) {
    EXPECT_TRUE(units_agree(formula, dimensions, parse_unit("N"))) << print(formula, kNames);
  }
}

}  // namespace
}  // namespace tribench::pysr::search_test
