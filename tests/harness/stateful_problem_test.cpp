// SPDX-License-Identifier: MIT
//
// A formula with a state goes through a cell as any other: fitted, judged, proved, printed, read.
#include "harness/stateful_problem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/registry.hpp"
#include "algorithms/states/state_column.hpp"
#include "foundation/error.hpp"
#include "harness/run_cell.hpp"
#include "harness/state_refit.hpp"
#include "harness/table_evaluator.hpp"
#include "problems/data_problem.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// Four strokes of a joint whose friction is 5 N m of Dahl's, 1000 N m/rad stiff, and an inertia.
Dataset recording(bool with_time) {
  Dataset data;
  data.name = "strokes";
  data.channels = {{"t", "s", with_time ? Role::time : Role::none, {}},
                   {"v", "rad/s", Role::velocity, {}},
                   {"a", "rad/s^2", Role::acceleration, {}},
                   {"tau", "N m", Role::friction_torque, {}}};
  data.movement_names = {"1", "2", "3", "4"};
  std::vector<double> time;
  std::vector<double> v;
  for (int r = 0; r < 1600; ++r) {
    time.push_back(0.005 * r);
    v.push_back(0.05 * std::sin(3.14159 * time.back() / 2) + 0.01 * std::sin(9 * time.back()));
    data.movement.push_back(r / 400);
  }
  const std::vector<const double*> columns = {v.data()};
  const std::vector<std::size_t> starts = {0};
  std::vector<double> z(v.size());
  state_column({"z", StateLaw::dahl, {0}, {0.005}}, {columns, time, starts}, z);
  for (std::size_t r = 0; r < v.size(); ++r) {
    const double a = 0.0785 * std::cos(3.14159 * time[r] / 2) + 0.09 * std::cos(9 * time[r]);
    const double noise = 0.05 * std::sin(12.9898 * static_cast<double>(r * r % 4001));
    data.channels[0].values.push_back(time[r]);
    data.channels[1].values.push_back(v[r]);
    data.channels[2].values.push_back(a);
    data.channels[3].values.push_back(1000 * z[r] + 3 * v[r] + 2 * a + noise);
  }
  return data;
}

Problem problem_of(const Dataset& data) {
  const std::vector<std::string> inputs = {"v", "a"};
  Problem problem = make_data_problem(data, nullptr, "tau", inputs);
  const std::vector<char> train = {1, 1, 0, 1};
  const std::vector<char> test = {0, 0, 1, 0};
  problem.stages[0].train = make_table({data, {}}, problem.inputs, "tau", train);
  problem.test = make_table({data, {}}, problem.inputs, "tau", test);
  return problem;
}

CellTask task_of(const std::string& method) {
  CellTask task;
  task.cell = {"strokes", method, "-", 1};
  task.operators = find_operator_set("paper");
  return task;
}

TEST(StatefulProblem, AStateIsTheWholeRecordingsWhateverRowsAreTaken) {
  const Problem problem = problem_of(recording(true));
  const std::vector<StateDeclaration> states = {{"z", StateLaw::dahl, {0}, {0.005}},
                                                {"v", StateLaw::lag, {0}, {0.1}}};
  const Problem extended = with_states(problem, states);
  ASSERT_EQ(extended.inputs.size(), 4U);
  EXPECT_EQ(extended.inputs[2].law, "dahl(v, sliding=0.005)");
  EXPECT_EQ(extended.inputs[3].name, "v2");  // a name that an input has
  EXPECT_EQ(extended.inputs[2].low, -0.005);
  // The third stroke's first row follows the second's last, which is a training row.
  const double before = extended.stages[0].train.columns[2][799];
  const double after = extended.test.columns[2][0];
  EXPECT_NE(after, 0);
  EXPECT_NEAR(after, before, 0.05 * 0.005);
}

TEST(StatefulProblem, ACellWithMemoryIsJudgedProvedAndReadBack) {
  const Problem problem = problem_of(recording(true));
  const Registry registry;
  const CellResult result = fit_and_judge(problem, *registry.make("dahl"), task_of("dahl"), {});
  const Record& record = result.record;
  ASSERT_TRUE(is_ok(record)) << reason_text(record.reason);
  EXPECT_THAT(record.formula, StartsWith("z = dahl(v, sliding=0.00"));
  EXPECT_LT(record.mae_test, 0.05);
  EXPECT_EQ(record.singularity, Singularity::proved_free);
  ASSERT_EQ(result.front.size(), 1U);
  EXPECT_EQ(result.front[0].formula, record.formula);
  const ProblemFormula read = read_problem_formula(record.formula, problem);
  ASSERT_TRUE(read.extended.has_value());
  EXPECT_EQ(formula_text(*read.extended, read.formula), record.formula);
  TableEvaluator evaluator;
  const auto values = evaluator.evaluate(read.formula, read.extended->test);
  double error = 0;
  for (std::size_t r = 0; r < values.size(); ++r) {
    error += std::abs(values[r] - problem.test.target[r]) / static_cast<double>(values.size());
  }
  EXPECT_NEAR(error, record.mae_test, 1e-15);
}

// Methods with memory read every input along the trail.
TEST(StatefulProblem, AStateStandsAlongTheTrailAsInTheTables) {
  const Problem problem = problem_of(recording(true));
  const Problem seen =
      with_declared_states(problem, {"z = dahl(v, sliding=0.002)", "w = dahl(v, sliding=0.01)"});
  const Problem other = *read_problem_formula("u = dahl(v, sliding=0.01); u", seen).extended;
  for (const Problem* extended : {&seen, &other}) {
    const Table& train = extended->stages.front().train;
    ASSERT_EQ(train.trail->columns.size(), extended->inputs.size());
    for (std::size_t j = 0; j < extended->inputs.size(); ++j) {
      for (std::size_t r = 0; r < train.rows(); ++r) {
        ASSERT_EQ(train.columns[j][r], train.trail->columns[j][train.trail_row[r]]);
      }
    }
  }
  EXPECT_EQ(problem.stages.front().train.trail->columns.size(), problem.inputs.size());
  const Registry registry;
  const CellResult result = fit_and_judge(seen, *registry.make("dahl"), task_of("dahl"), {});
  EXPECT_TRUE(is_ok(result.record)) << reason_text(result.record.reason);
}

// A user's guess of a state beside a method that knows nothing of states.
TEST(StatefulProblem, ADeclaredStateIsAnInputWhoseParametersAreFittedAfterwards) {
  const Problem problem = problem_of(recording(true));
  const Problem seen = with_declared_states(problem, {"z = dahl(v, sliding=0.002)"});
  const Registry registry;
  CellResult result = fit_and_judge(seen, *registry.make("linear"), task_of("linear"), {});
  ASSERT_TRUE(is_ok(result.record)) << reason_text(result.record.reason);
  EXPECT_THAT(result.record.formula, StartsWith("z = dahl(v, sliding=0.002); "));
  const double before = result.record.mae_test;
  refit_states(problem, result);
  EXPECT_LT(result.record.mae_test, 0.2 * before);
  EXPECT_THAT(result.record.formula, StartsWith("z = dahl(v, sliding=0.00"));
  const ProblemFormula read = read_problem_formula(result.record.formula, seen);
  EXPECT_EQ(formula_text(*read.extended, read.formula), result.record.formula);
  EXPECT_THROW(with_declared_states(problem, {"v = dahl(v, sliding=0.002)"}), Error);
}

TEST(StatefulProblem, WithoutTimeACellSaysWhy) {
  const Problem problem = problem_of(recording(false));
  const Registry registry;
  const CellResult result = fit_and_judge(problem, *registry.make("lugre"), task_of("lugre"), {});
  EXPECT_EQ(result.record.status, CellStatus::failed);
  EXPECT_THAT(reason_text(result.record.reason), HasSubstr("time"));
  const std::vector<StateDeclaration> states = {{"z", StateLaw::dahl, {0}, {0.005}}};
  EXPECT_THROW(with_states(problem, states), Error);
}

}  // namespace
}  // namespace tribench
