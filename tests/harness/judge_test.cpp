// SPDX-License-Identifier: MIT
#include "harness/judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "algorithms/expression/text.hpp"
#include "algorithms/registry.hpp"
#include "foundation/error.hpp"
#include "harness/run_cell.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// y = 2 v + 1 without noise; a second stage in which 3 g is left on top.
Problem two_stage_problem() {
  Problem problem;
  problem.name = "test/staged";
  problem.dataset = "test";
  problem.inputs = {{"v", "rad/s", Role::velocity, -2, 2, {}}, {"g", "N m", Role::none, -1, 1, {}}};
  const auto table = [](double slope_of_g) {
    Table t;
    t.columns.resize(2);
    for (int i = 0; i < 40; ++i) {
      const double v = -2 + 0.1 * i;
      const double g = i % 2 == 0 ? 0.5 : -0.25;
      t.columns[0].push_back(v);
      t.columns[1].push_back(g);
      t.target.push_back(2 * v + 1 + slope_of_g * g);
      t.movement.push_back(i / 10);
    }
    return t;
  };
  problem.stages = {{"fit", {0}, table(0)}, {"adapt", {1}, table(3)}};
  problem.test = table(3);
  problem.test.truth = problem.test.target;
  return problem;
}

// Least squares a line over the first input that it sees: exact where a line is the truth.
class LineMethod : public Regressor {
 public:
  FitResult fit(FitContext& context) const override {
    const double* x = context.data.columns[0];
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t r = 0; r < context.data.rows(); ++r) {
      const double y = context.data.target[r];
      n += 1;
      sx += x[r];
      sy += y;
      sxx += x[r] * x[r];
      sxy += x[r] * y;
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    const std::string name = context.data.inputs[0].name;
    FitResult result;
    const std::vector<std::string> names = {name};
    result.front.push_back(Expression::constant(sy / n));
    result.front.push_back(parse(
        print_number(slope) + " * " + name + " + " + print_number((sy - slope * sx) / n), names));
    result.chosen = 1;
    EXPECT_TRUE(context.budget.spend(100));
    return result;
  }
};

TEST(FitAndJudge, AddsTheStagesFormulasAndCountsTheAdaptationApart) {
  const Problem problem = two_stage_problem();
  CellTask task;
  task.cell = {problem.name, "line", "paper", 1};
  task.operators = find_operator_set("paper");
  const CellResult result = fit_and_judge(problem, LineMethod(), task);
  const Record& record = result.record;
  EXPECT_TRUE(is_ok(record)) << reason_text(record.reason);
  EXPECT_NEAR(record.mae_test, 0, 1e-12);
  EXPECT_NEAR(record.mae_truth, 0, 1e-12);
  EXPECT_NEAR(record.r2_test, 1, 1e-12);
  // (2 v + 1) + (3 g + 0), without the 0: two products, two sums, two variables.
  EXPECT_EQ(record.complexity, 6);
  EXPECT_EQ(record.complexity_adaptation, 2);
  EXPECT_EQ(record.evaluations, 200U);
  EXPECT_EQ(record.singularity, Singularity::proved_free);
  ASSERT_EQ(result.front.size(), 2U);
  EXPECT_TRUE(result.front.back().chosen);
  // What is exported is what was judged.
  const Expression formula = parse(record.formula, problem.input_names());
  Record again;
  judge_formula(problem, {formula, {}}, again);
  EXPECT_EQ(again.mae_test, record.mae_test);
}

// Has found one formula beforehand.
class FormulaMethod : public Regressor {
 public:
  explicit FormulaMethod(std::string formula) : formula_(std::move(formula)) {}
  FitResult fit(FitContext& context) const override {
    const std::vector<std::string> names = {context.data.inputs[0].name};
    FitResult result;
    result.front = {Expression::constant(0), parse(formula_, names)};
    result.chosen = 1;
    EXPECT_TRUE(context.budget.spend(100));
    return result;
  }

 private:
  std::string formula_;
};

TEST(FitAndJudge, FurtherRoundsOnFewRowsCountByExactFormulasAlone) {
  Problem problem = two_stage_problem();
  problem.stages.pop_back();
  for (int i = 0; i < 40; ++i) {  // 0.3 cos(10 pi v), which no row held out has heard of
    problem.stages[0].train.target[static_cast<std::size_t>(i)] += i % 2 == 0 ? 0.3 : -0.3;
  }
  CellTask task;
  task.cell = {problem.name, "line", "full", 1};
  task.operators = find_operator_set("full");
  task.limits.evaluations = 5000;
  task.limits.spend = true;
  const auto formula_after = [&](const std::string& found_by_a_wider_search) {
    const auto wider = [&](int) {
      return std::make_unique<FormulaMethod>(found_by_a_wider_search);
    };
    const CellResult result = fit_and_judge(problem, LineMethod(), task, wider);
    EXPECT_TRUE(is_ok(result.record)) << reason_text(result.record.reason);
    return result.record.formula;
  };
  EXPECT_THAT(formula_after("2*v + 1 + 0.25*cos(31.41592653589793*v)"), Not(HasSubstr("cos")));
  EXPECT_THAT(formula_after("2*v + 1 + 0.3*cos(31.41592653589793*v)"), HasSubstr("cos"));
}

// Too small a budget is to be told from a method that fails: how much it takes, or how little it
// was.
TEST(FitAndJudge, ABudgetThatEndsBeforeAFirstFormulaIsSaidToHave) {
  const Problem problem = two_stage_problem();
  const Registry registry;
  const auto reason = [&](const std::string& method, std::uint64_t evaluations) {
    CellTask task;
    task.cell = {problem.name, method, "full", 1};
    task.operators = find_operator_set("full");
    task.limits.evaluations = evaluations;
    return reason_text(fit_and_judge(problem, *registry.make(method), task).record.reason);
  };
  // A constant and a slope over 40 rows, of half of the budget: there are two stages.
  EXPECT_THAT(reason("linear", 200),
              HasSubstr("no formula: it takes 160 evaluations (node-rows), and 100 are left"));
  EXPECT_EQ(reason("linear", 320), "");
  EXPECT_THAT(reason("parfam", 50), HasSubstr("no formula: the budget of 50 evaluations and 60 CPU "
                                              "seconds ended before a first one"));
}

// Notes the seconds that each search was given.
class NotingMethod : public LineMethod {
 public:
  FitResult fit(FitContext& context) const override {
    given_.push_back(context.budget.remaining_seconds());
    return LineMethod::fit(context);
  }
  double first() const { return given_.at(0); }

 private:
  mutable std::vector<double> given_;
};

TEST(FitAndJudge, AFirstSearchOfFewRowsLeavesSecondsToBeMadeAgain) {
  Problem problem = two_stage_problem();
  problem.stages.pop_back();
  CellTask task;
  task.cell = {problem.name, "line", "full", 1};
  task.operators = find_operator_set("full");
  task.limits.evaluations = 200;
  const auto share = [&](double seconds, bool spend) {
    task.limits.seconds = seconds;
    task.limits.spend = spend;
    const NotingMethod method;
    fit_and_judge(problem, method, task);
    return method.first() / seconds;
  };
  EXPECT_NEAR(share(60, true), 0.4, 0.01);
  EXPECT_NEAR(share(10, true), 0.9, 0.01);  // a search has too little of that already
  EXPECT_NEAR(share(60, false), 0.9, 0.01);
}

// Refuses data of which the first input has another name.
class ParticularMethod : public LineMethod {
 public:
  explicit ParticularMethod(std::string wanted) : wanted_(std::move(wanted)) {}
  FitResult fit(FitContext& context) const override {
    if (context.data.inputs[0].name != wanted_) {
      throw_bad_input("'" + wanted_ + "' is not an input", "template");
    }
    return LineMethod::fit(context);
  }

 private:
  std::string wanted_;
};

TEST(FitAndJudge, TakesWhatAMethodRefusesBesideTheDataForUnsupported) {
  const Problem problem = two_stage_problem();
  CellTask task;
  task.cell = {problem.name, "particular", "paper", 1};
  task.operators = find_operator_set("paper");
  const Record first = fit_and_judge(problem, ParticularMethod("v"), task).record;
  EXPECT_TRUE(is_ok(first)) << reason_text(first.reason);
  EXPECT_EQ(first.note, "no adapt: template: 'v' is not an input");
  EXPECT_EQ(first.complexity_adaptation, 0);
  const Record none = fit_and_judge(problem, ParticularMethod("g"), task).record;
  EXPECT_EQ(reason_text(none.reason), "unsupported (template: 'g' is not an input)");
}

TEST(FitAndJudge, ShowsAMethodNoInputThatDoesNotVaryInItsRows) {
  // The line method divides by the spread of the first input it sees: of a constant that is zero.
  Problem problem = two_stage_problem();
  for (Stage& stage : problem.stages) stage.inputs.insert(stage.inputs.begin(), 2);
  problem.inputs.push_back({"sgn_g", "-", Role::gravity_sign, -1, 1, {}});
  for (Stage& stage : problem.stages) stage.train.columns.emplace_back(stage.train.rows(), 1.0);
  problem.test.columns.emplace_back(problem.test.rows(), -1.0);
  CellTask task;
  task.cell = {problem.name, "line", "paper", 1};
  task.operators = find_operator_set("paper");
  const CellResult result = fit_and_judge(problem, LineMethod(), task);
  EXPECT_NEAR(result.record.mae_test, 0, 1e-12) << reason_text(result.record.reason);
  EXPECT_EQ(result.record.formula.find("sgn_g"), std::string::npos) << result.record.formula;
}

TEST(JudgeFormula, FailsAFormulaWithoutAValueAtATestRow) {
  const Problem problem = two_stage_problem();
  Record record;
  judge_formula(problem, {parse("log(v)", problem.input_names()), {}}, record);
  EXPECT_EQ(record.status, CellStatus::failed);
  EXPECT_THAT(reason_text(record.reason), HasSubstr("no finite value at 2"));
  EXPECT_TRUE(std::isnan(record.mae_test));
  EXPECT_EQ(record.singularity, Singularity::refuted);
  EXPECT_THAT(record.witness, HasSubstr("\"v\""));
  EXPECT_EQ(record.formula, "log(v)");
}

Record judged(const std::string& formula) {
  const Problem problem = two_stage_problem();
  Record record;
  judge_formula(problem, {parse(formula, problem.input_names()), {}}, record);
  return record;
}

TEST(JudgeFormula, SaysWhetherAGridWouldHaveSeenTheSingularity) {
  EXPECT_EQ(judged("1 / v").grid_check, GridCheck::seen);  // 0 is on the grid
  EXPECT_EQ(judged("1 / (v - 0.3141592653589793)").grid_check, GridCheck::missed);
  EXPECT_EQ(judged("v").grid_check, std::nullopt);
}

TEST(JudgeFormula, AsksPhysicsOfFormulasThatAreProvedFree) {
  const Record line = judged("2 * v");
  EXPECT_EQ(line.dissipative, PhysicsProof::proved);
  EXPECT_EQ(line.monotone, PhysicsProof::proved);
  EXPECT_EQ(line.odd, PhysicsProof::proved);
  EXPECT_EQ(judged("2 * v + 1").dissipative, PhysicsProof::refuted);
  EXPECT_EQ(judged("2 * v + 1").odd, PhysicsProof::refuted);
  EXPECT_EQ(judged("1 / v").dissipative, std::nullopt);
  EXPECT_EQ(judged("1 / v").odd, std::nullopt);
}

// A Stribeck curve falls near standstill, and that is no fault: 0.5 is a quarter of the top speed.
TEST(JudgeFormula, AsksForAGrowingFrictionBeyondTheStribeckRange) {
  EXPECT_EQ(judged("v^3 - 0.2 * v").monotone, PhysicsProof::proved);   // falls up to 0.26
  EXPECT_EQ(judged("v^3 - 0.5 * v").monotone, PhysicsProof::refuted);  // f(-0.5) > f(0.5)
  EXPECT_EQ(judged("v^3 - 3 * v").monotone, PhysicsProof::refuted);    // falls up to 1
}

// The top speed is that of the faster direction: up to 2 of 8 friction may fall.
TEST(JudgeFormula, TakesTheStribeckRangeOfTheFasterDirection) {
  Problem problem = two_stage_problem();
  problem.inputs[0].high = 8;
  Record record;
  judge_formula(problem, {parse("v^3 - 3 * v", problem.input_names()), {}}, record);
  EXPECT_EQ(record.monotone, PhysicsProof::proved);
}

// The shortest of five rounds: five times as long is less than judging took, whatever else ran.
// Many rows, so that a round is one evaluation of them and the rest takes little.
TEST(JudgeFormula, SaysATimePerRowInNanoseconds) {
  Problem problem = two_stage_problem();
  for (Input& input : problem.inputs) input.role = Role::none;
  problem.test = {};
  problem.test.columns.resize(2);
  for (int i = 0; i < 200'000; ++i) {
    problem.test.columns[0].push_back(1e-5 * i);
    problem.test.columns[1].push_back(0.5);
    problem.test.target.push_back(1);
    problem.test.movement.push_back(0);
  }
  std::string text = "sin(v)";
  for (int k = 2; k < 12; ++k) text += " + sin(" + std::to_string(k) + " * v)";
  const StagedFormula waves{parse(text, problem.input_names()), {}};
  Record record;
  const auto start = std::chrono::steady_clock::now();
  judge_formula(problem, waves, record);
  const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
  EXPECT_GT(record.eval_ns_per_row, 0);
  EXPECT_LT(5 * record.eval_ns_per_row * 200'000, taken.count());
}

// Without a test row there is nothing to take the time of.
TEST(JudgeFormula, TakesTheTimeOfTestRowsAlone) {
  Problem problem = two_stage_problem();
  Record record;
  const StagedFormula line{parse("2 * v + 1", problem.input_names()), {}};
  judge_formula(problem, line, record);
  EXPECT_GT(record.eval_ns_per_row, 0);
  problem.test = {};
  problem.test.columns.resize(2);
  judge_formula(problem, line, record);
  EXPECT_TRUE(std::isnan(record.eval_ns_per_row));
}

TEST(JudgeFront, KeepsNoFormulaWithoutAnErrorBesideOneThatHasIt) {
  const Problem problem = two_stage_problem();
  const std::vector<std::string> names = problem.input_names();
  const std::vector<Expression> front = {parse("log(v)", names), parse("2 * v + 1", names)};
  const std::vector<FrontRecord> kept = judge_front(problem, front, 1, {});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].formula, "2*v + 1");
  // Two without an error beat nothing, not even each other.
  const std::vector<Expression> none = {parse("log(v)", names), parse("log(2*v)", names)};
  EXPECT_EQ(judge_front(problem, none, 0, {}).size(), 2U);
}

TEST(JudgeFront, KeepsWhatNoOtherBeatsAndTheChosenOne) {
  const Problem problem = two_stage_problem();
  const std::vector<std::string> names = problem.input_names();
  const std::vector<Expression> front = {
      parse("2 * v + 1 + 3 * g", names),  // exact
      parse("2 * v + 1", names),          // simpler, worse
      parse("1.9 * v + g * v", names),    // beaten by the one above
      parse("v * v * v", names),          // beaten, but chosen
  };
  Record judged;
  judged.cell = "cell";
  judged.singularity = Singularity::undecided;
  const std::vector<FrontRecord> kept = judge_front(problem, front, 3, judged);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].formula, "2*v + 1");
  EXPECT_TRUE(kept[1].chosen);
  EXPECT_EQ(kept[2].formula, "2*v + 1 + 3*g");
  EXPECT_EQ(kept[1].singularity, Singularity::undecided);  // not proved a second time
  EXPECT_EQ(kept[0].singularity, Singularity::proved_free);
  EXPECT_EQ(kept[2].singularity, Singularity::proved_free);
}

}  // namespace
}  // namespace tribench
