// SPDX-License-Identifier: MIT
#include "problems/kuka/entries.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/glob.hpp"
#include "problems/catalogue.hpp"

namespace tribench {
namespace {

double mean_error(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t r = 0; r < a.size(); ++r) sum += std::abs(a[r] - b[r]);
  return sum / static_cast<double>(a.size());
}

TEST(KukaEntries, SplitByWholeMovementEightyAndTen) {
  const Catalogue catalogue;
  for (const char* name : {"A/j2/no_load", "A/j4/no_load", "A/j2/load", "A/j4/load"}) {
    const Problem problem = catalogue.find(name).make(4);
    const Table& train = problem.stages.front().train;
    const std::set<int> trained(train.movement.begin(), train.movement.end());
    const std::set<int> tested(problem.test.movement.begin(), problem.test.movement.end());
    EXPECT_EQ(trained.size(), 80U) << name;
    EXPECT_EQ(tested.size(), 10U) << name;
    for (const int movement : tested) EXPECT_EQ(trained.count(movement), 0U) << name;
    EXPECT_EQ(train.rows(), problem.load ? 3200U : 80U);
    EXPECT_EQ(problem.test.rows(), problem.load ? 2000U : 10U);
    EXPECT_EQ(problem.test.truth.size(), problem.test.rows());
  }
}

TEST(KukaEntries, HaveThePapersInputsAndAreInsideTheirBox) {
  const Catalogue catalogue;
  for (const ProblemEntry& entry : catalogue.entries()) {
    if (!glob_matches("?/j?/*load*", entry.name)) continue;
    const Problem problem = entry.make(2);
    const bool with_gravity = problem.dataset == "B" || problem.load;
    const std::vector<std::string> expected =
        with_gravity ? std::vector<std::string>{"qd", "sgn_qd", "g", "sgn_g"}
                     : std::vector<std::string>{"qd", "sgn_qd"};
    EXPECT_EQ(problem.input_names(), expected) << entry.name;
    EXPECT_EQ(problem.inputs[1].sign_of, std::optional<std::size_t>(0));
    const auto inside = [&](const Table& table) {
      for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
        const auto [low, high] =
            std::minmax_element(table.columns[j].begin(), table.columns[j].end());
        EXPECT_GE(*low, problem.inputs[j].low) << entry.name << " " << problem.inputs[j].name;
        EXPECT_LE(*high, problem.inputs[j].high) << entry.name << " " << problem.inputs[j].name;
      }
    };
    for (const Stage& stage : problem.stages) inside(stage.train);
    inside(problem.test);
  }
}

TEST(KukaEntries, TheTrueLawGivesTheTruth) {
  const Catalogue catalogue;
  Evaluator evaluator;
  for (const char* name :
       {"A/j2/no_load", "A/j4/no_load", "A/j2/load", "A/j4/load", "B/j2/no_load", "B/j4/load"}) {
    const Problem problem = catalogue.find(name).make(9);
    const Expression law = parse(problem.true_law(), problem.input_names());
    std::vector<const double*> columns;
    for (const auto& column : problem.test.columns) columns.push_back(column.data());
    std::vector<double> values(problem.test.rows());
    evaluator.evaluate(law, {columns, values.size()}, values);
    EXPECT_LT(mean_error(values, problem.test.truth), 1e-12) << name;
    EXPECT_GT(mean_error(values, problem.test.target), 1e-3) << name;
  }
}

TEST(KukaEntries, AdaptationSeesOneUnloadedMovementAndThreeInputs) {
  const Catalogue catalogue;
  const Problem problem = catalogue.find("B/j2/load").make(1);
  ASSERT_EQ(problem.stages.size(), 2U);
  const Stage& adapt = problem.stages[1];
  EXPECT_EQ(adapt.inputs, (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(std::set<int>(adapt.train.movement.begin(), adapt.train.movement.end()).size(), 1U);
  EXPECT_EQ(adapt.train.rows(), 2000U);
  // Unloaded: within the arm's own gravity, which the loaded test leaves.
  const auto largest = [](const std::vector<double>& g) {
    return std::max(-*std::min_element(g.begin(), g.end()), *std::max_element(g.begin(), g.end()));
  };
  EXPECT_LE(largest(adapt.train.columns[2]), 1.08 * 42.4);
  EXPECT_GT(largest(problem.test.columns[2]), 1.08 * 42.4);
  EXPECT_EQ(catalogue.find("B/j2/load/unadapted").make(1).stages.size(), 1U);
}

TEST(KukaEntries, TheAdaptationMovementIsNoTestMovement) {
  const Catalogue catalogue;
  const Problem problem = catalogue.find("B/j4/no_load").make(1);
  const std::set<double> adapted(problem.stages[1].train.target.begin(),
                                 problem.stages[1].train.target.end());
  for (const double value : problem.test.target) EXPECT_EQ(adapted.count(value), 0U);
}

TEST(KukaEntries, TheRecordingHasEveryChannelAndAllMovements) {
  const Catalogue catalogue;
  const Dataset data = catalogue.find("A/j2/load").data(1);
  EXPECT_EQ(data.movement_names.size(), 90U);
  EXPECT_EQ(data.rows(), 3600U);
  for (const Role role :
       {Role::time, Role::position, Role::velocity, Role::gravity_torque, Role::friction_torque}) {
    EXPECT_NE(data.find(role), nullptr) << role_name(role);
  }
}

}  // namespace
}  // namespace tribench
