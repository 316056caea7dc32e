// SPDX-License-Identifier: MIT
#include "algorithms/parfam/parfam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "problems/catalogue.hpp"
#include "tests/support/fit.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using testing::FitOptions;
using testing::mean_absolute_error;
using testing::run_fit;
using testing::Training;

// Rows of a table with its inputs, owned.
struct Sample {
  std::vector<Input> inputs;
  std::vector<std::vector<double>> columns;
  std::vector<double> target;
  std::vector<const double*> pointers;
  std::vector<int> movement;

  explicit Sample(std::vector<Input> wanted) : inputs(std::move(wanted)), columns(inputs.size()) {}
  TrainingData data() {
    pointers.clear();
    for (const auto& column : columns) pointers.push_back(column.data());
    movement.resize(target.size());
    for (std::size_t r = 0; r < target.size(); ++r) movement[r] = static_cast<int>(r);
    return {inputs, pointers, target, movement};
  }
};

double sign(double x) { return static_cast<double>(x > 0) - static_cast<double>(x < 0); }

std::vector<Input> peer_inputs(bool load) {
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1.9, 1.9, {}},
                               {"s", "-", Role::velocity_sign, -1, 1, std::size_t{0}}};
  if (load) {
    inputs.push_back({"g", "N m", Role::gravity_torque, -60, 60, {}});
    inputs.push_back({"sg", "-", Role::gravity_sign, -1, 1, std::size_t{2}});
  }
  return inputs;
}

// The peer problems' training data and their noise-free test grids.
Sample peer_training(const std::filesystem::path& folder, bool load) {
  Sample sample(peer_inputs(load));
  std::ifstream in(folder / "peer_problems" / (load ? "load4d_train.csv" : "friction1d_train.csv"));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (auto& column : sample.columns) {
      std::getline(cells, cell, ',');
      column.push_back(std::stod(cell));
    }
    std::getline(cells, cell, ',');
    sample.target.push_back(std::stod(cell));
  }
  return sample;
}

Sample peer_test(bool load) {
  Sample sample(peer_inputs(load));
  for (int k = 0; k < 2001; ++k) {
    const double v = -1.9 + 3.8 * k / 2000;
    if (k == 1000) continue;  // v = 0 is left out
    const double s = sign(v);
    const double g = 60 * std::sin(2 * std::numbers::pi * 37 * k / 2001 + 0.3);
    sample.columns[0].push_back(v);
    sample.columns[1].push_back(s);
    if (load) {
      sample.columns[2].push_back(g);
      sample.columns[3].push_back(sign(g));
      sample.target.push_back(8 * s * (1 + 0.012 * std::abs(g)) + 12 * v - 3 * v * v * v / 3.6 +
                              0.05 * g * s * sign(g));
    } else {
      sample.target.push_back((3.66 * v + 8.52 * s - 0.44) *
                              std::exp(-0.78 * v * v + 1.26 * std::abs(v) + 0.02 * v - 0.02 * s));
    }
  }
  return sample;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

TEST(ParFam, BeatsThePeersOnTheirProblems) {
  const auto reference = testing::shared_reference();
  if (!reference) GTEST_SKIP() << testing::kNoSharedData;
  for (const bool load : {false, true}) {
    Sample training = peer_training(*reference, load);
    Sample test = peer_test(load);
    std::vector<double> errors;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const FitResult result = run_fit(training.data(), "parfam", {.seed = seed});
      errors.push_back(
          mean_absolute_error(result.front.at(result.chosen), test.data(), test.target));
    }
    EXPECT_LE(median(errors), load ? 0.0100 : 0.0052);
  }
}

TEST(ParFam, ComesNearTheTrueLawOnAveragedDataOfBothJoints) {
  for (const char* name : {"A/j2/no_load", "A/j4/no_load"}) {
    std::vector<double> ratios;
    for (std::uint64_t seed = 1; seed <= 9; ++seed) {
      const Problem problem = Catalogue().find(name).make(seed);
      const Training training(problem);
      std::vector<const double*> columns;
      for (const auto& column : problem.test.columns) columns.push_back(column.data());
      const TrainingData test{problem.inputs, columns, problem.test.target, problem.test.movement};
      Expression law = parse(problem.true_law(), problem.input_names());
      ConstantFitter().fit(law, training.data().table(), training.table->target, {},
                           {.max_iterations = 50});
      const FitResult result = run_fit(training.data(), "parfam", {.seed = seed});
      const Expression& chosen = result.front.at(result.chosen);
      EXPECT_LE(paper_complexity(chosen), 23);
      ratios.push_back(mean_absolute_error(chosen, test, problem.test.truth) /
                       mean_absolute_error(law, test, problem.test.truth));
    }
    EXPECT_LE(median(ratios), 1.25) << name;
  }
}

Sample sample_of(const std::string& law, std::vector<std::string> names, std::size_t rows) {
  std::vector<Input> inputs;
  for (const std::string& name : names) inputs.push_back({name, "-", Role::none, 1, 3, {}});
  Sample sample(inputs);
  RandomStream random(17);
  for (auto& column : sample.columns) {
    for (std::size_t r = 0; r < rows; ++r) column.push_back(random.uniform(1, 3));
  }
  sample.target.resize(rows);
  Evaluator().evaluate(parse(law, names), sample.data().table(), sample.target);
  return sample;
}

TEST(ParFam, RecoversFormulasOfItsFamiliesExactly) {
  struct Case {
    const char* law;
    std::vector<std::string> names;
  };
  for (const Case& c :
       {Case{"x*exp(-0.5*y^2)", {"x", "y"}}, Case{"2*cos(1.5*x + 0.3*y) + y", {"x", "y"}},
        Case{"x*sqrt(y^2 + z^2)", {"x", "y", "z"}}, Case{"3 + x*y^3 - 2*z", {"x", "y", "z"}},
        Case{"x/(1 + (0.5*y - 0.2*x)^2)", {"x", "y"}}}) {
    Sample sample = sample_of(c.law, c.names, 150);
    const FitResult result = run_fit(sample.data(), "parfam", {.operators = "full"});
    EXPECT_LT(mean_absolute_error(result.front.at(result.chosen), sample.data(), sample.target),
              1e-8)
        << c.law << " as " << print(result.front[result.chosen], c.names);
  }
}

TEST(ParFam, GivesTheSameFrontForAnyNumberOfThreads) {
  const Problem problem = Catalogue().find("A/j2/no_load").make(1);
  const Training training(problem);
  const FitResult one = run_fit(training.data(), "parfam", {.operators = "paper+div"});
  const FitResult four =
      run_fit(training.data(), "parfam", {.operators = "paper+div", .threads = 4});
  EXPECT_EQ(one.front, four.front);
  EXPECT_EQ(one.chosen, four.chosen);
}

TEST(ParFam, KeepsToItsOperatorsAndItsProofs) {
  const Problem problem = Catalogue().find("A/j4/no_load").make(2);
  const Training training(problem);
  for (const OperatorSet& set : operator_sets()) {
    for (const char* mode : {"ours", "original"}) {
      const FitResult result = run_fit(training.data(), "parfam",
                                       {.parameters = {{"mode", std::string(mode)}},
                                        .operators = set.name(),
                                        .limits = {.evaluations = 60'000'000}});
      for (const Expression& formula : result.front) EXPECT_TRUE(set.admits(formula));
      if (!set.proved_free_only()) continue;
      InputBox box;
      for (const Input& input : training.inputs)
        box.push_back({input.low, input.high, input.sign_of});
      for (const Expression& formula : result.front) {
        EXPECT_EQ(prove_free(formula, box).verdict, Verdict::proved_free);
      }
    }
  }
}

// A hyperbola whose pole lies in the input box and beyond the rows: a free denominator takes it.
Sample hyperbola() {
  Sample sample({{"x", "-", Role::none, -1, 1, {}}});
  RandomStream random(5);
  for (int r = 0; r < 40; ++r) {
    const double x = -0.5 + r / 39.0;
    sample.columns[0].push_back(x);
    sample.target.push_back(x / (x - 0.8) + 0.01 * random.normal());
  }
  return sample;
}

std::size_t count_divisions(const Expression& formula) {
  return static_cast<std::size_t>(
      std::ranges::count_if(formula.nodes(), [](const Node& node) { return node.op == Op::div; }));
}

TEST(ParFam, OnlyFreeDenominatorsHavePoles) {
  const InputBox box = {{-1, 1, {}}};
  for (const char* denominators : {"safe", "constrained", "free"}) {
    Sample sample = hyperbola();
    const FitResult result = run_fit(sample.data(), "parfam",
                                     {.parameters = {{"denominators", std::string(denominators)},
                                                     {"functions", std::int64_t{0}}},
                                      .operators = "paper+div"});
    std::size_t refuted = 0;
    std::size_t divisions = 0;
    for (const Expression& formula : result.front) {
      divisions += count_divisions(formula);
      refuted += prove_free(formula, box).verdict == Verdict::proved_free ? 0 : 1;
    }
    EXPECT_GT(divisions, 0U) << denominators;
    if (std::string(denominators) == "free") {
      EXPECT_GT(refuted, 0U);
    } else {
      EXPECT_EQ(refuted, 0U) << denominators;
    }
  }
}

TEST(ParFam, ConstrainedDenominatorsFindARatioThatIsNoSquare) {
  // 1 + 0.8 x is above 0 on the box, and no 1 + q^2.
  Sample sample({{"x", "-", Role::none, -1, 1, {}}});
  for (int r = 0; r < 60; ++r) {
    const double x = -1 + 2.0 * r / 59;
    sample.columns[0].push_back(x);
    sample.target.push_back((1 - 2 * x) / (1 + 0.8 * x));
  }
  const FitResult result = run_fit(
      sample.data(), "parfam",
      {.parameters = {{"denominators", std::string("constrained")}, {"functions", std::int64_t{0}}},
       .operators = "paper+div"});
  EXPECT_LT(mean_absolute_error(result.front.at(result.chosen), sample.data(), sample.target), 1e-8)
      << print(result.front[result.chosen], std::vector<std::string>{"x"});
}

TEST(ParFam, SearchesOneFamilyWhereItIsGiven) {
  Sample sample = sample_of("x*exp(-0.5*y^2)", {"x", "y"}, 80);
  for (const char* mode : {"ours", "original"}) {
    const FitResult result = run_fit(
        sample.data(), "parfam",
        {.parameters = {{"mode", std::string(mode)}, {"family", std::string("1/0 exp 2/0")}}});
    ASSERT_FALSE(result.front.empty());
    const FitResult refused = run_fit(
        sample.data(), "parfam",
        {.parameters = {{"mode", std::string(mode)}, {"family", std::string("1/0 cos 2/0")}}});
    EXPECT_EQ(refused.reason, StopReason::unsupported);
  }
}

TEST(ParFam, SpendsNoMoreThanItsBudgetAndStillAnswers) {
  const Problem problem = Catalogue().find("A/j2/load").make(1);
  const Training training(problem);
  for (const std::uint64_t evaluations : {1000ULL, 20'000'000ULL}) {
    const FitResult result =
        run_fit(training.data(), "parfam", {.limits = {.evaluations = evaluations}});
    EXPECT_EQ(result.reason, StopReason::budget);
    if (evaluations > 1000) EXPECT_FALSE(result.front.empty());
  }
}

TEST(ParFam, EveryOptimiserSearches) {
  Sample sample = sample_of("x*exp(-0.5*y^2)", {"x", "y"}, 60);
  for (const char* optimizer :
       {"multi_start", "basin_hopping", "mlsl", "crs2", "esch", "isres", "direct_l", "ipopt"}) {
    const FitResult result =
        run_fit(sample.data(), "parfam", {.parameters = {{"optimizer", std::string(optimizer)}}});
    EXPECT_LT(mean_absolute_error(result.front.at(result.chosen), sample.data(), sample.target),
              1e-3)
        << optimizer;
  }
}

TEST(ParFam, AsPublishedFindsAPolynomial) {
  Sample sample = sample_of("1 + 2*x - 0.5*x*y", {"x", "y"}, 100);
  const FitResult result =
      run_fit(sample.data(), "parfam", {.parameters = {{"mode", std::string("original")}}});
  ASSERT_EQ(result.front.size(), 1U);
  EXPECT_LT(mean_absolute_error(result.front[0], sample.data(), sample.target), 0.02)
      << print(result.front[0], std::vector<std::string>{"x", "y"});
}

}  // namespace
}  // namespace tribench
