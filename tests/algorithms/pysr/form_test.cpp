// SPDX-License-Identifier: MIT
#include "algorithms/pysr/form.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/pysr/constraints.hpp"
#include "algorithms/pysr/random_formula.hpp"
#include "algorithms/pysr/simplify.hpp"
#include "algorithms/registry.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr::form_test {
namespace {

const std::vector<std::string> kNames = {"v", "sgn_v", "load"};
constexpr const char* kTemplate = "sgn_v*f(abs(v)) + g(load)";

Expression formula(const char* text) { return parse(text, kNames); }
Expression local(const char* text) {
  const std::vector<std::string> arguments = {"a", "b"};
  return parse(text, arguments);
}

std::string mend_of(const char* text) {
  try {
    const Form form(text, kNames);
  } catch (const Error& error) {
    return error.place() + ": " + error.mend();
  }
  return "accepted";
}

TEST(Form, PutsPartsInAndFindsThemAgain) {
  const Form form(kTemplate, kNames);
  ASSERT_EQ(form.parts(), 2u);
  const Expression parts[] = {local("2 + a*a"), local("3*a")};
  const Expression whole = form.assembled([&](std::size_t k) { return parts[k]; });
  EXPECT_EQ(form.part(whole, 0), parts[0]);
  EXPECT_EQ(form.part(whole, 1), parts[1]);
  EXPECT_TRUE(form.fits(whole));
  EXPECT_EQ(print(form.columns().written_out(whole), kNames), "sgn_v*(2 + abs(v)*abs(v)) + 3*load");
  const Expression other = form.with_part(whole, 0, local("exp(a)"));
  EXPECT_EQ(print(form.columns().written_out(other), kNames), "sgn_v*exp(abs(v)) + 3*load");
}

TEST(Form, ReadsWhatItHasWrittenAndNothingElse) {
  const Form form("2*f(abs(v), load)^2 - exp(-load)*g(load)/p()", kNames);
  RandomStream random(key_of("forms"));
  const OperatorSet& operators = find_operator_set("paper");
  for (int i = 0; i < 500; ++i) {
    const Expression whole = form.assembled(
        [&](std::size_t part) { return random_part(form, part, i % 7, operators, random); });
    EXPECT_TRUE(form.fits(whole));
    EXPECT_EQ(form.read(form.columns().written_out(whole)), whole);
    EXPECT_TRUE(form.fits(simplified(form, whole)));
  }
  EXPECT_EQ(parts_text(form, kNames, formula("2*abs(v)^2 - exp(-load)*(load + 1)/3")),
            "f = abs(v); g = load + 1; p = 3");
  EXPECT_EQ(parts_text(form, kNames, formula("load")), "");
  EXPECT_FALSE(form.read(formula("2*v^2 - exp(-load)*load/3")).has_value());
  EXPECT_FALSE(form.read(formula("2*load^2 - exp(-load)*abs(v)/3")).has_value());
  EXPECT_FALSE(form.read(formula("2*load^3 - exp(-load)*load/3")).has_value());
  EXPECT_FALSE(form.read(formula("3*load^2 - exp(-load)*load/3")).has_value());
  EXPECT_FALSE(form.read(formula("load")).has_value());
  EXPECT_TRUE(form.read(formula("2*load^2 - exp(-load)*load/3")).has_value());
}

TEST(Form, ComputesItsFurtherColumnsOnce) {
  const Form form(kTemplate, kNames);
  const Rows rows = form.columns().extended(Rows({{-2, 3}, {-1, 1}, {5, 6}}, {0, 0}), kNames);
  ASSERT_EQ(rows.columns.size(), 4u);
  EXPECT_EQ(rows.columns[3], (std::vector<double>{2, 3}));
  EXPECT_THROW(Form("f(log(v))", kNames).columns().extended(Rows({{-2}, {-1}, {5}}, {0}), kNames),
               Error);
}

TEST(Form, NamesThePlaceAndTheMendOfABadTemplate) {
  EXPECT_EQ(mend_of("sgn_v*v").substr(0, 8), "template");
  EXPECT_EQ(mend_of("f(v) + f(load)"), "template, character 8: give every part a name of its own");
  EXPECT_EQ(mend_of("f(g(v))"), "template, character 3: let that part find its inner form");
  EXPECT_EQ(mend_of("v(load)"), "template, character 1: give the part another name");
  EXPECT_EQ(mend_of("f(laod)"), "template, character 3: did you mean load?");
  EXPECT_EQ(mend_of("f(v"), "template, character 4: add a ')'");
  EXPECT_EQ(mend_of("f(2)"), "template: name inputs, or nothing for a number to be fitted");
  EXPECT_EQ(mend_of(kTemplate), "accepted");
}

TEST(Form, HoldsTheConstraintsInsideItsParts) {
  const std::vector<Input> inputs = {{"v", "m/s"}, {"sgn_v", "-"}, {"load", "N"}};
  Options options;
  options.part_sizes = "g=3";
  options.nested_limits = "exp>exp=0";
  const Form form("abs(f(v)) + g(load)", kNames);
  const Validator validator(options, find_operator_set("paper"), inputs, form);
  // abs is the template's and need not be in the set; of a part it must.
  const auto admits = [&](const char* text) { return validator.admits(formula(text), 30); };
  EXPECT_TRUE(admits("abs(exp(v)) + 3*load"));
  EXPECT_FALSE(admits("abs(exp(v)) + abs(load)"));
  EXPECT_FALSE(admits("abs(exp(v)) + (3*load + 1)"));
  EXPECT_FALSE(admits("abs(exp(exp(v))) + load"));
  EXPECT_FALSE(admits("abs(load) + load"));
  EXPECT_FALSE(admits("exp(v) + load"));
  options.part_sizes = "h=3";
  EXPECT_THROW(Validator(options, find_operator_set("paper"), inputs, form), Error);
}

// sgn(v) (4 + 3 exp(-5 |v|) + 2 sqrt(|v|)) + load exp(-load / 4), noise 0.02 N m.
struct Planted {
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -2, 2, {}},
                               {"sgn_v", "-", Role::velocity_sign, -1, 1, 0},
                               {"load", "N", Role::gravity_torque, 0, 10, {}}};
  std::vector<std::vector<double>> columns{3};
  std::vector<double> truth;
  std::vector<double> target;
  std::vector<int> movement;
  std::vector<const double*> pointers;

  Planted() {
    RandomStream random(key_of("planted form"));
    for (int r = 0; r < 150; ++r) {
      const double v = random.uniform(-2, 2);
      const double load = random.uniform(0, 10);
      const double s = v > 0 ? 1 : -1;
      columns[0].push_back(v);
      columns[1].push_back(s);
      columns[2].push_back(load);
      truth.push_back(s * (4 + 3 * std::exp(-5 * std::abs(v)) + 2 * std::sqrt(std::abs(v))) +
                      load * std::exp(-load / 4));
      target.push_back(truth.back() + 0.02 * random.normal());
      movement.push_back(r);
    }
    for (const auto& column : columns) pointers.push_back(column.data());
  }
  TrainingData data() const { return {inputs, pointers, target, movement}; }
};

using Given = std::map<std::string, ParameterValue>;

FitResult fit(const Planted& problem, const Given& given, std::uint64_t seed = 1, int threads = 1,
              std::uint64_t evaluations = 20'000'000) {
  const Registry registry;
  const auto method = registry.make("pysr", given);
  const TrainingData data = problem.data();
  Budget budget(BudgetLimits{evaluations});
  FitContext context{data,   find_operator_set("paper"), budget, RandomStream(seed), threads,
                     nullptr};
  return method->fit(context);
}

double error_of_truth(const Expression& found, const Planted& problem) {
  std::vector<double> values(problem.truth.size());
  Evaluator().evaluate(found, problem.data().table(), values);
  double sum = 0;
  for (std::size_t r = 0; r < values.size(); ++r) sum += std::abs(values[r] - problem.truth[r]);
  return sum / static_cast<double>(values.size());
}

Given with_template(const char* text) { return {{"template", std::string(text)}}; }

TEST(Template, FindsAPlantedLawMoreOftenThanABlankSearch) {
  const Planted problem;
  int found = 0;
  int found_blank = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const FitResult grey = fit(problem, with_template(kTemplate), seed);
    const FitResult blank = fit(problem, {}, seed);
    found += error_of_truth(grey.front[grey.chosen], problem) < 0.01 ? 1 : 0;
    found_blank += error_of_truth(blank.front[blank.chosen], problem) < 0.01 ? 1 : 0;
  }
  EXPECT_GE(found, 5);
  EXPECT_LE(found_blank, found - 2);
}

TEST(Template, IsTheFormOfEveryFormulaOfTheFrontInEveryProfile) {
  const Planted problem;
  const Form form(kTemplate, kNames);
  for (const char* profile : {"native", "v1", "v2"}) {
    Given given = with_template(kTemplate);
    given["profile"] = std::string(profile);
    given["iterations"] = std::int64_t{2};
    given["populations"] = std::int64_t{3};
    given["cycles"] = std::int64_t{60};
    const FitResult result = fit(problem, given);
    EXPECT_GE(result.front.size(), 2u) << profile;
    for (const Expression& found : result.front) {
      const Expression read = parse(print(found, kNames), kNames);
      EXPECT_EQ(read, found);
      EXPECT_TRUE(form.read(read).has_value()) << print(found, kNames);
      EXPECT_LE(columns_used(found), kNames.size());
    }
    EXPECT_EQ(fit(problem, given, 1, 8).front, result.front) << profile;
  }
}

TEST(Template, LeavesItsOwnConstantsAndFitsItsNumbers) {
  const Planted problem;
  const FitResult result = fit(problem, with_template("p()*sgn_v + 1.25*f(load)^2 + q()*v"));
  const Form form("p()*sgn_v + 1.25*f(load)^2 + q()*v", kNames);
  for (const Expression& found : result.front) EXPECT_TRUE(form.read(found).has_value());
  const FitResult two = fit(problem, with_template("p()*sgn_v + q()*v"));
  EXPECT_EQ(two.note.substr(0, 4), "p = ");
  const Expression numbers = two.front.back();
  EXPECT_EQ(constant_positions(numbers).size(), 2u);
  EXPECT_LT(error_of_truth(numbers, problem), 1.5);
}

TEST(Template, StartsFromAGuessOfItsFormAndRefusesAnother) {
  const Planted problem;
  Given given = with_template(kTemplate);
  given["profile"] = std::string("v1");
  given["iterations"] = std::int64_t{1};
  given["cycles"] = std::int64_t{1};
  given["guesses"] =
      std::string("sgn_v*(3 + 2*exp(-4*abs(v)) + 1.5*sqrt(abs(v))) + load*exp(-0.3*load)");
  EXPECT_LT(error_of_truth(fit(problem, given).front.back(), problem), 0.02);
  given["guesses"] = std::string("v*load");
  EXPECT_THROW(fit(problem, given), Error);
}

TEST(Template, AnswersWhereThereIsNothingToSearch) {
  Planted problem;
  const Form form(kTemplate, kNames);
  const FitResult nothing = fit(problem, with_template(kTemplate), 1, 1, 0);
  ASSERT_EQ(nothing.front.size(), 1u);
  EXPECT_TRUE(form.read(nothing.front[0]).has_value());
  problem.target.assign(problem.target.size(), 3.5);
  problem.truth = problem.target;
  const FitResult constant = fit(problem, with_template(kTemplate));
  ASSERT_FALSE(constant.front.empty());
  EXPECT_LT(error_of_truth(constant.front[constant.chosen], problem), 1e-9);
  problem.target.assign(problem.target.size(), 0);
  EXPECT_FALSE(fit(problem, with_template(kTemplate)).front.empty());
}

TEST(Template, RefusesWhatWouldBreakIt) {
  const Planted problem;
  Given given = with_template(kTemplate);
  given["max_size"] = std::int64_t{4};
  EXPECT_THROW(fit(problem, given), Error);
  given = with_template(kTemplate);
  given["mutation_weights"] = std::string("backsolve=1");
  EXPECT_THROW(fit(problem, given), Error);
}

}  // namespace
}  // namespace tribench::pysr::form_test
