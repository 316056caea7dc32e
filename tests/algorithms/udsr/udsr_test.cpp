// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "algorithms/admission.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/registry.hpp"

namespace tribench {
namespace {

// The form of the paper's own formula: (3.66 v + 8.52 s - 0.44) times an exponential.
struct FrictionCurve {
  std::vector<double> v, s, y, truth;
  std::vector<int> movement;
  std::vector<const double*> columns;
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1.9, 1.9, std::nullopt},
                               {"sgn_v", "-", Role::velocity_sign, -1, 1, 0}};

  explicit FrictionCurve(int rows = 100) {
    RandomStream random(41);
    for (int i = 0; i < rows; ++i) {
      const double x = -1.9 + 3.8 * i / (rows - 1);
      v.push_back(x);
      s.push_back(x > 0 ? 1 : -1);
      truth.push_back((3.66 * x + 8.52 * s.back() - 0.44) *
                      std::exp(-0.78 * x * x + 1.26 * std::abs(x) + 0.02 * x - 0.02 * s.back()));
      y.push_back(truth.back() + 0.05 * random.normal());
      movement.push_back(i);
    }
    columns = {v.data(), s.data()};
  }
  TrainingData data() const { return {inputs, columns, y, movement}; }
};

using Given = std::map<std::string, ParameterValue>;

const Given kSmall = {
    {"steps", std::int64_t{2}}, {"batch", std::int64_t{60}}, {"generations", std::int64_t{3}}};

FitResult fit(const FrictionCurve& curve, const Given& parameters, int threads = 1,
              std::uint64_t evaluations = 40'000'000, const char* operators = "paper") {
  const Registry registry;
  const TrainingData data = curve.data();
  Budget budget({evaluations, INFINITY});
  FitContext context{data, find_operator_set(operators), budget, RandomStream(7), threads};
  return registry.make("udsr", parameters)->fit(context);
}

double truth_error(const FrictionCurve& curve, const Expression& formula) {
  std::vector<double> values(curve.y.size());
  Evaluator().evaluate(formula, curve.data().table(), values);
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += std::abs(values[i] - curve.truth[i]);
  return sum / static_cast<double>(values.size());
}

// Whoever asks several methods goes on with the others.
TEST(Udsr, CannotDoMoreInputsThanItHasTokensFor) {
  FrictionCurve curve;
  while (curve.columns.size() < 64) {
    curve.inputs.push_back(
        {"x" + std::to_string(curve.columns.size()), "-", Role::none, -2, 2, {}});
    curve.columns.push_back(curve.v.data());
  }
  const FitResult result = fit(curve, kSmall);
  EXPECT_EQ(result.reason, StopReason::unsupported);
  EXPECT_NE(result.note.find("library holds 64"), std::string::npos) << result.note;
}

TEST(Udsr, FindsAFrictionCurveToWithinItsNoise) {
  const FrictionCurve curve;
  const FitResult result = fit(curve, {{"steps", std::int64_t{3}}});
  ASSERT_FALSE(result.front.empty());
  EXPECT_LT(truth_error(curve, result.front[result.chosen]), 0.05);
  for (const Expression& formula : result.front) {
    EXPECT_TRUE(find_operator_set("paper").admits(formula));
  }
}

// What a sample of the rows has shown is fitted to all of them: errors of the constants fall with
// the root of the rows, and those of a search among the 4 000 sampled rows alone would be twice as
// large.
TEST(Udsr, SearchesASampleOfManyRowsAndFitsThemAll) {
  const FrictionCurve many(20000);
  const FitResult result = fit(many, kSmall, 1, 2'000'000'000);
  ASSERT_FALSE(result.front.empty());
  const Expression best = result.front.back();
  ConstantFitter fitter;
  Expression refitted = best;
  fitter.fit(refitted, many.data().table(), many.y);
  EXPECT_NEAR(truth_error(many, best), truth_error(many, refitted), 1e-6);
  EXPECT_LT(truth_error(many, best), 0.05);
}

TEST(Udsr, GivesTheSameFrontForAnyNumberOfThreads) {
  const FrictionCurve curve;
  Given parameters = kSmall;
  parameters["batch"] = std::int64_t{600};  // enough for the threads to be used
  const FitResult one = fit(curve, parameters, 1);
  const FitResult three = fit(curve, parameters, 3);
  EXPECT_EQ(one.front, three.front);
  EXPECT_EQ(one.chosen, three.chosen);
}

TEST(Udsr, ChoosesNoRefutedFormulaAndOffersNoneWhereTheOperatorSetAsksForProofs) {
  const FrictionCurve curve;
  const InputBox box = input_box(curve.inputs);
  const auto unproved = [&](const FitResult& result) {
    return std::ranges::count_if(result.front, [&](const Expression& formula) {
      return prove_free(formula, box).verdict != Verdict::proved_free;
    });
  };
  const FitResult risky = fit(curve, kSmall, 1, 100'000'000, "paper+div");
  EXPECT_GT(unproved(risky), 0);
  EXPECT_NE(prove_free(risky.front[risky.chosen], box).verdict, Verdict::refuted);
  EXPECT_EQ(unproved(fit(curve, kSmall, 1, 100'000'000, "paper+safe_div")), 0);
}

TEST(Udsr, EveryPartCanBeSwitchedAndMatters) {
  const FrictionCurve curve;
  const FitResult standard = fit(curve, kSmall);
  const std::vector<std::pair<std::string, ParameterValue>> changes = {
      {"linear_token", false},          {"genetic", false},
      {"weights", std::string("none")}, {"policy", std::string("priority_queue")},
      {"policy", std::string("ppo")},   {"policy", std::string("none")},
      {"degree", std::int64_t{2}},      {"constants", false},
      {"max_length", std::int64_t{12}}};
  for (const auto& [name, value] : changes) {
    Given parameters = kSmall;
    parameters[name] = value;
    const FitResult changed = fit(curve, parameters);
    ASSERT_FALSE(changed.front.empty()) << name;
    EXPECT_NE(changed.front, standard.front) << name;
  }
}

// Two inputs that add up: the recursion has something to reduce, and its parts enter the front.
TEST(Udsr, TheRecursionCanBeSwitchedOffAndMatters) {
  std::vector<double> v, g, y;
  std::vector<int> movement;
  RandomStream random(43);
  for (int i = 0; i < 120; ++i) {
    v.push_back(random.uniform(-1, 1));
    g.push_back(random.uniform(-1, 1));
    y.push_back(std::exp(1.5 * v.back()) + 2 * std::sin(3 * g.back()) + 0.02 * random.normal());
    movement.push_back(i);
  }
  const std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1, 1, std::nullopt},
                                     {"g", "N m", Role::gravity_torque, -1, 1, std::nullopt}};
  const std::vector<const double*> columns = {v.data(), g.data()};
  const TrainingData data{inputs, columns, y, movement};
  const auto front = [&](bool recursion) {
    Given parameters = kSmall;
    parameters["recursion"] = recursion;
    Budget budget({200'000'000, INFINITY});
    FitContext context{data, find_operator_set("full"), budget, RandomStream(7)};
    return Registry().make("udsr", parameters)->fit(context).front;
  };
  EXPECT_NE(front(true), front(false));
}

// What follows the search (a reduction, hundreds of terms, fits on all rows) looks at the clock
// too.
TEST(Udsr, KeepsItsSecondsOnManyRowsAndInputs) {
  constexpr std::size_t kRows = 12000;
  RandomStream random(53);
  std::vector<Input> inputs;
  std::vector<std::vector<double>> values;
  std::vector<const double*> columns;
  for (int j = 0; j < 9; ++j) {
    inputs.push_back({"x" + std::to_string(j), "-", Role::none, -1, 1, std::nullopt});
    values.emplace_back();
    for (std::size_t r = 0; r < kRows; ++r) values.back().push_back(random.uniform(-1, 1));
  }
  for (const auto& column : values) columns.push_back(column.data());
  std::vector<double> y;
  std::vector<int> movement;
  for (std::size_t r = 0; r < kRows; ++r) {
    y.push_back(values[0][r] * values[1][r] + std::exp(values[2][r]) + random.normal());
    movement.push_back(static_cast<int>(r));
  }
  const TrainingData data{inputs, columns, y, movement};
  // The least of three: what else the machine does makes a second of a processor worth less.
  double least = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < 3; ++attempt) {
    Budget budget({.cpu_seconds = 0.7});
    FitContext context{data, find_operator_set("full"), budget, RandomStream(7)};
    const double start = process_cpu_seconds();
    EXPECT_FALSE(Registry().make("udsr", {})->fit(context).front.empty());
    least = std::min(least, process_cpu_seconds() - start);
  }
#ifndef TRIBENCH_SANITIZED  // whose instructions cost several times as much
  EXPECT_LT(least, 1.2);
#endif
}

}  // namespace
}  // namespace tribench
