// SPDX-License-Identifier: MIT
//
// What every registered method must keep to, whatever it is: the rules of regressor.hpp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/registry.hpp"

namespace tribench {
namespace {

// Velocity, its sign and a target, as a friction problem has them.
struct Sample {
  std::vector<Input> inputs;
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  std::vector<double> target;
  std::vector<int> movement;
  std::vector<double> time;  // a hundredth of a second apart
  std::vector<std::size_t> motion_row;
  std::vector<std::size_t> starts = {0};

  TrainingData data() {
    pointers.clear();
    time.clear();
    motion_row.clear();
    for (const auto& column : columns) pointers.push_back(column.data());
    for (std::size_t r = 0; r < target.size(); ++r) {
      time.push_back(0.01 * static_cast<double>(r));
      motion_row.push_back(r);
    }
    TrainingData data{inputs, pointers, target, movement};
    data.motion = {pointers, time, starts};
    data.motion_row = motion_row;
    return data;
  }
  std::vector<std::string> names(const FitResult& result) const {
    std::vector<std::string> names;
    for (const Input& input : inputs) names.push_back(input.name);
    for (const StateDeclaration& state : result.states) names.push_back(state.name);
    return names;
  }
};

std::vector<double> values_of(const FitResult& result, Sample& sample) {
  const TrainingData data = sample.data();
  std::vector<std::vector<double>> states;
  std::vector<const double*> columns(data.columns.begin(), data.columns.end());
  for (const StateDeclaration& state : result.states) {
    states.emplace_back(data.rows());
    state_column(state, data.motion, states.back());
    columns.push_back(states.back().data());
  }
  std::vector<double> values(data.rows());
  Evaluator().evaluate(result.front[result.chosen], {columns, data.rows()}, values);
  return values;
}

Sample friction_sample(std::size_t rows, double scale = 1) {
  Sample sample;
  sample.inputs = {{"v", "rad/s", Role::velocity, -2, 2, std::nullopt},
                   {"sgn_v", "-", Role::velocity_sign, -1, 1, 0}};
  sample.columns.resize(2);
  RandomStream random(key_of("conformance"));
  for (std::size_t r = 0; r < rows; ++r) {
    const double v =
        rows == 1 ? 0.5 : -2 + 4 * (static_cast<double>(r) + 0.5) / static_cast<double>(rows);
    const double s = v > 0 ? 1 : -1;
    sample.columns[0].push_back(v);
    sample.columns[1].push_back(s);
    sample.target.push_back(
        scale * (6 * s + 3 * v + 2 * s * std::exp(-5 * std::abs(v)) + 0.05 * random.normal()));
    sample.movement.push_back(static_cast<int>(r / 8));
  }
  return sample;
}

constexpr std::uint64_t kEvaluations = 20'000'000;

struct Setting {
  std::uint64_t evaluations = kEvaluations;
  int threads = 1;
  std::uint64_t key = 7;
  std::string operators = "paper";
};

struct Outcome {
  FitResult result;
  std::uint64_t spent = 0;
};

Outcome run(const Registry& registry, const std::string& name, Sample& sample,
            const Setting& setting = {}) {
  const auto method = registry.make(name);
  const TrainingData data = sample.data();
  Budget budget({setting.evaluations, 20});
  FitContext context{data,
                     find_operator_set(setting.operators),
                     budget,
                     RandomStream(setting.key),
                     setting.threads,
                     nullptr};
  Outcome outcome{method->fit(context), 0};
  outcome.spent = budget.spent();
  return outcome;
}

std::vector<std::string> texts(const FitResult& result, const Sample& sample) {
  std::vector<std::string> texts;
  for (const Expression& formula : result.front)
    texts.push_back(print(formula, sample.names(result)));
  return texts;
}

// Legal: the place of the choice is in the front, the formulas read back as themselves.
void expect_legal(const FitResult& result, const Sample& sample) {
  if (result.reason == StopReason::unsupported) {
    EXPECT_FALSE(result.note.empty()) << "unsupported without a reason";
    return;
  }
  if (!result.front.empty()) {
    EXPECT_LT(result.chosen, result.front.size());
  }
  for (const Expression& formula : result.front) {
    EXPECT_LE(columns_used(formula), sample.inputs.size() + result.states.size());
    const std::vector<std::string> names = sample.names(result);
    EXPECT_EQ(parse(print(formula, names), names), formula);
  }
  for (const StateDeclaration& state : result.states) check_state(state, sample.inputs.size());
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  const Registry registry;
  for (const AlgorithmEntry& entry : registry.entries()) names.push_back(entry.name);
  return names;
}

class EveryMethod : public testing::TestWithParam<std::string> {
 protected:
  Registry registry_;
};

TEST_P(EveryMethod, GivesTheSameFrontForOneTwoAndEightThreads) {
  Sample sample = friction_sample(80);
  Setting setting;
  setting.evaluations = 30'000'000;
  const Outcome one = run(registry_, GetParam(), sample, setting);
  for (const int threads : {2, 8}) {
    setting.threads = threads;
    const Outcome many = run(registry_, GetParam(), sample, setting);
    EXPECT_EQ(texts(many.result, sample), texts(one.result, sample)) << threads << " threads";
    EXPECT_EQ(many.result.chosen, one.result.chosen);
    EXPECT_EQ(many.spent, one.spent) << threads << " threads";
  }
}

// parfam and udsr once gave another formula where a column was called g, T or tau_m.
TEST_P(EveryMethod, FindsTheSameWhateverTheColumnsAreCalled) {
  Sample sample = friction_sample(40);
  for (Input& input : sample.inputs) input.role = Role::none;
  Setting setting;
  setting.evaluations = 1'000'000;
  const Outcome plain = run(registry_, GetParam(), sample, setting);
  for (const auto& [first, second] : {std::pair("g", "T"), std::pair("tau_m", "a")}) {
    sample.inputs[0].name = first;
    sample.inputs[1].name = second;
    const Outcome named = run(registry_, GetParam(), sample, setting);
    EXPECT_EQ(named.result.front, plain.result.front) << first;
    EXPECT_EQ(named.result.chosen, plain.result.chosen) << first;
  }
}

TEST_P(EveryMethod, ReturnsAtOnceWithoutABudget) {
  Sample sample = friction_sample(80);
  Setting setting;
  setting.evaluations = 0;
  const double start = process_cpu_seconds();
  const Outcome outcome = run(registry_, GetParam(), sample, setting);
  EXPECT_LT(process_cpu_seconds() - start, 0.5);
  EXPECT_EQ(outcome.spent, 0u);
  expect_legal(outcome.result, sample);
}

TEST_P(EveryMethod, KeepsItsBudget) {
  Sample sample = friction_sample(80);
  for (const std::uint64_t evaluations : {1'000u, 100'000u, 3'000'000u}) {
    Setting setting;
    setting.evaluations = evaluations;
    const Outcome outcome = run(registry_, GetParam(), sample, setting);
    EXPECT_LE(outcome.spent, evaluations + evaluations / 100);
    expect_legal(outcome.result, sample);
  }
}

TEST_P(EveryMethod, AnswersDataWithNaN) {
  Sample sample = friction_sample(80);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  sample.target[3] = nan;
  sample.columns[0][10] = nan;
  sample.target[11] = std::numeric_limits<double>::infinity();
  expect_legal(run(registry_, GetParam(), sample).result, sample);
  for (double& value : sample.target) value = nan;
  expect_legal(run(registry_, GetParam(), sample).result, sample);
}

TEST_P(EveryMethod, AnswersAConstantTarget) {
  Sample sample = friction_sample(80);
  for (const double constant : {3.25, 0.0}) {
    for (double& value : sample.target) value = constant;
    expect_legal(run(registry_, GetParam(), sample).result, sample);
  }
}

// Every residual has the same size: there is no largest one, and no smallest.
TEST_P(EveryMethod, AnswersATargetOfTwoValues) {
  Sample sample = friction_sample(80);
  for (std::size_t r = 0; r < 80; ++r) sample.target[r] = r % 2 == 0 ? 1 : -1;
  expect_legal(run(registry_, GetParam(), sample).result, sample);
}

TEST_P(EveryMethod, AnswersInputsThatDoNotVary) {
  Sample sample = friction_sample(80);
  for (const double speed : {0.5, 0.0}) {
    for (double& value : sample.columns[0]) value = speed;
    for (double& value : sample.columns[1]) value = speed > 0 ? 1 : 0;
    expect_legal(run(registry_, GetParam(), sample).result, sample);
  }
}

TEST_P(EveryMethod, AnswersFewRows) {
  for (const std::size_t rows : {2, 3, 5, 10, 20}) {
    Sample sample = friction_sample(rows);
    expect_legal(run(registry_, GetParam(), sample).result, sample);
  }
}

// What a method makes of its inputs grows with their pairs at most as long as these are few: two
// thousand have two million products.
TEST_P(EveryMethod, AnswersThousandsOfInputsInSeconds) {
  Sample sample = friction_sample(60);
  RandomStream random(key_of("many inputs"));
  for (int j = 2; j < 2000; ++j) {
    sample.inputs.push_back({fmt::format("x{}", j), "-", Role::none, 0, 1, std::nullopt});
    sample.columns.emplace_back();
    for (std::size_t r = 0; r < 60; ++r) sample.columns.back().push_back(random.uniform());
  }
  const double begin_s = process_cpu_seconds();
  expect_legal(run(registry_, GetParam(), sample, {.operators = "full"}).result, sample);
  EXPECT_LT(process_cpu_seconds() - begin_s, 8);
}

TEST_P(EveryMethod, AnswersASingleRow) {
  Sample sample = friction_sample(1);
  expect_legal(run(registry_, GetParam(), sample).result, sample);
}

TEST_P(EveryMethod, AnswersTargetsOfAnyScale) {
  for (const double scale : {1e6, 1e-6}) {
    Sample sample = friction_sample(80, scale);
    const Outcome outcome = run(registry_, GetParam(), sample);
    expect_legal(outcome.result, sample);
    if (outcome.result.front.empty()) continue;
    const std::vector<double> values = values_of(outcome.result, sample);
    double error = 0;
    double size = 0;
    for (std::size_t r = 0; r < values.size(); ++r) {
      error += std::abs(values[r] - sample.target[r]);
      size += std::abs(sample.target[r]);
    }
    EXPECT_LE(error, size) << "worse than predicting 0 at scale " << scale;
  }
}

TEST_P(EveryMethod, KeepsToItsOperatorSetAndRepeatsNoFormula) {
  if (registry_.find(GetParam()).fixed_form) GTEST_SKIP() << "a fixed form has no operator set";
  for (const std::string set : {"paper", "paper+div", "full"}) {
    Sample sample = friction_sample(80);
    Setting setting;
    setting.operators = set;
    setting.evaluations = 6'000'000;
    const Outcome outcome = run(registry_, GetParam(), sample, setting);
    for (const Expression& formula : outcome.result.front) {
      EXPECT_TRUE(find_operator_set(set).admits(formula))
          << set << ": " << print(formula, sample.names(outcome.result));
    }
    std::vector<std::string> formulas = texts(outcome.result, sample);
    std::ranges::sort(formulas);
    EXPECT_EQ(std::ranges::adjacent_find(formulas), formulas.end());
  }
}

TEST_P(EveryMethod, OffersOnlyProvedFormulasWhereTheSetAdmitsNoOthers) {
  if (registry_.find(GetParam()).fixed_form) GTEST_SKIP() << "a fixed form has no operator set";
  Sample sample = friction_sample(80);
  InputBox box;
  for (const Input& input : sample.inputs) box.push_back({input.low, input.high, input.sign_of});
  Setting setting;
  setting.operators = "paper+safe_div";
  setting.evaluations = 6'000'000;
  for (setting.key = 1; setting.key <= 3; ++setting.key) {
    const Outcome outcome = run(registry_, GetParam(), sample, setting);
    for (const Expression& formula : outcome.result.front) {
      EXPECT_EQ(prove_free(formula, box).verdict, Verdict::proved_free)
          << print(formula, sample.names(outcome.result));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryMethod, testing::ValuesIn(method_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace tribench
