// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "algorithms/pysr/options.hpp"
#include "algorithms/registry.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr::parameters_test {
namespace {

using Given = std::map<std::string, ParameterValue>;

// 3 sqrt(v) + load exp(-load / 2), noise 0.05. All v are positive, the box is not.
struct Problem {
  std::vector<Input> inputs = {{"v", "m/s", Role::velocity, -2, 2, {}},
                               {"load", "N", Role::gravity_torque, 0, 5, {}}};
  std::vector<std::vector<double>> columns{2};
  std::vector<double> target;
  std::vector<int> movement;
  std::vector<const double*> pointers;

  Problem() {
    RandomStream random(key_of("parameters"));
    for (int r = 0; r < 80; ++r) {
      const double v = random.uniform(0.01, 2);
      const double load = random.uniform(0, 5);
      columns[0].push_back(v);
      columns[1].push_back(load);
      target.push_back(3 * std::sqrt(v) + load * std::exp(-load / 2) + 0.05 * random.normal());
      movement.push_back(r);
    }
    for (const auto& column : columns) pointers.push_back(column.data());
  }
};

class Trace : public Progress {
 public:
  void improved(double train_error, std::uint64_t evaluations) override {
    steps.emplace_back(train_error, evaluations);
  }
  std::vector<std::pair<double, std::uint64_t>> steps;
};

// All that a parameter can change of a fit.
struct Outcome {
  std::vector<Expression> front;
  std::size_t chosen;
  std::vector<std::pair<double, std::uint64_t>> trace;
  std::uint64_t spent;
  bool operator==(const Outcome&) const = default;
};

Outcome fit(const Problem& problem, Given given) {
  // Small, where the case says nothing else.
  given.emplace("profile", std::string("v2"));
  given.emplace("iterations", std::int64_t{3});
  given.emplace("populations", std::int64_t{3});
  given.emplace("cycles", std::int64_t{40});
  const auto method = Registry().make("pysr", given);
  const TrainingData data{problem.inputs, problem.pointers, problem.target, problem.movement};
  Budget budget(BudgetLimits{300'000'000});
  Trace trace;
  FitContext context{data, find_operator_set("paper"), budget, RandomStream(5), 1, &trace};
  const FitResult result = method->fit(context);
  return {result.front, result.chosen, trace.steps, budget.spent()};
}

// Whether units are looked at or not.
TEST(PysrParameters, ATargetsUnitIsOneThatIsKnown) {
  EXPECT_THROW(Registry().make("pysr", {{"target_unit", std::string("blah")}}), Error);
  EXPECT_NO_THROW(Registry().make("pysr", {{"target_unit", std::string("N m")}}));
}

struct Case {
  std::string name;
  ParameterValue value;
  Given beside = {};  // what it needs to matter
};

std::int64_t whole(int value) { return value; }
std::string text(const char* value) { return value; }

std::vector<Case> cases() {
  const Given few = {{"profile", text("native")}, {"constructions", whole(3)}};
  const Given grey = {{"template", text("f(v) + g(load)")}};
  const Given hard = {{"units", text("hard")}, {"target_unit", text("N")}};
  const Given batched = {{"batching", text("on")}, {"batch_size", whole(32)}};
  return {
      {"profile", text("native")},
      {"iterations", whole(2)},
      {"populations", whole(2)},
      {"population_size", whole(20)},
      {"cycles", whole(30)},
      {"patience", whole(1), {{"iterations", whole(40)}, {"cycles", whole(5)}}},
      {"max_size", whole(9)},
      {"max_depth", whole(3)},
      {"warm_up", 1.0},
      {"initial_operators", whole(5)},
      {"tournament_size", whole(5)},
      {"tournament_probability", 0.5},
      {"parsimony", 0.1},
      {"adaptive_parsimony", 20.0},
      {"use_frequency", text("off")},
      {"use_frequency_in_tournament", text("off")},
      {"crossover_probability", 0.6},
      {"mutation_weights", text("add_node=9")},
      {"mutation_burst", true},
      {"skip_failures", text("off")},
      {"adaptive_weights", text("off")},
      {"annealing", text("off")},
      {"alpha", 1e-4},
      {"perturbation_factor", 5.0, {{"mutation_weights", text("mutate_constant=5")}}},
      {"negate_probability", 1.0},
      {"compat", true},
      {"replaced_by_peers", 0.5},
      {"replaced_by_front", 0.9},
      {"replaced_by_guesses", 0.9, {{"guesses", text("v")}}},
      {"top_n", whole(1), {{"replaced_by_peers", 0.5}}},
      {"optimize_probability", 1.0},
      {"optimize_iterations", whole(1)},
      {"optimize_restarts", whole(0)},
      {"batching", text("on"), {{"batch_size", whole(32)}}},
      {"batch_size", whole(16), batched},
      {"search_rows", whole(40)},
      {"select_features", whole(1)},
      {"denoise", true},
      {"template", text("f(v) + g(load)")},
      {"part_sizes", text("f=3"), grey},
      {"argument_limits", text("*:1,1")},
      {"nested_limits", text("*>*=0")},
      {"operator_sizes", text("*=3")},
      {"constant_size", 2.0},
      {"variable_size", 2.0},
      {"units", text("hard"), {{"target_unit", text("N")}}},
      {"target_unit", text("m/s"), hard},
      {"unit_penalty", 0.0, {{"units", text("soft")}, {"target_unit", text("N")}}},
      {"guesses", text("sqrt(v)*2 + load*exp(-0.4*load)")},
      {"selection", text("accuracy")},
      {"fit_children", text("on")},
      {"novelty", text("off"), few},
      {"linear_scaling", text("off"), few},
      {"constructions", whole(4), few},
      {"climbs", whole(0), few},
      {"evidence_cost", text("off"), few},
      {"safe", true},
      {"refine", text("on")},
  };
}

TEST(Parameters, AllMatterAndEveryOneHasACaseHere) {
  const Problem problem;
  std::set<std::string> named;
  for (const Case& one : cases()) {
    named.insert(one.name);
    Given given = one.beside;
    const Outcome without = fit(problem, given);
    given[one.name] = one.value;
    EXPECT_FALSE(fit(problem, given) == without) << one.name;
  }
  std::set<std::string> declared;
  for (const ParameterSpec& spec : parameter_specs()) declared.insert(spec.name);
  EXPECT_EQ(named, declared);
}

TEST(Parameters, LeaveWhatIsNotGivenToTheProfile) {
  const auto options = [](const Given& given) {
    return options_from(Parameters(parameter_specs(), given));
  };
  for (const char* name : {"native", "v1", "v2"}) {
    const Options read = options({{"profile", std::string(name)}});
    const Options profile = profile_options(read.profile);
    EXPECT_EQ(read.iterations, profile.iterations) << name;
    EXPECT_EQ(read.weights, profile.weights) << name;
    EXPECT_EQ(read.annealing, profile.annealing) << name;
    EXPECT_EQ(read.selection, profile.selection) << name;
    EXPECT_EQ(read.batching, profile.batching) << name;
    EXPECT_EQ(read.max_depth, read.max_size) << name;
  }
  EXPECT_EQ(options({{"max_size", std::int64_t{17}}}).max_depth, 17);
  EXPECT_EQ(options({{"max_depth", std::int64_t{5}}}).max_depth, 5);
}

}  // namespace
}  // namespace tribench::pysr::parameters_test
