// SPDX-License-Identifier: MIT
#include "harness/decades_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/elementary.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

constexpr int kRates = 150;

// Has found a front beforehand, of the target and of its logarithm, which has one input more.
class TwoFronts : public Regressor {
 public:
  TwoFronts(std::vector<std::string> plain, std::vector<std::string> logarithm)
      : plain_(std::move(plain)), logarithm_(std::move(logarithm)) {}

  FitResult fit(FitContext& context) const override {
    std::vector<std::string> names;
    for (const Input& input : context.data.inputs) names.push_back(input.name);
    const bool of_logarithm = names.size() > 2;
    searches.push_back(of_logarithm ? "logarithm" : "target");
    FitResult result;
    for (const std::string& formula : of_logarithm ? logarithm_ : plain_) {
      result.front.push_back(parse(formula, names));
    }
    result.chosen = result.front.size() - 1;
    result.keeps_form = keeps_form;
    EXPECT_TRUE(context.budget.spend(100));
    return result;
  }

  bool keeps_form = false;
  mutable std::vector<std::string> searches;

 private:
  std::vector<std::string> plain_;
  std::vector<std::string> logarithm_;
};

using Noise = std::function<double(double, RandomStream&)>;

// A rate of 4e5 x^2 exp(-6000 / T) times a million, over four decades and more.
class DecadesFitTest : public ::testing::Test {
 protected:
  void make(const Noise& noise) {
    problem_.name = "test/rate";
    problem_.dataset = "test";
    problem_.inputs = {{"T", "", Role::none, 290, 500, {}}, {"x", "", Role::none, 0.1, 10, {}}};
    Table table;
    table.columns.resize(2);
    RandomStream random(5);
    for (int r = 0; r < kRates; ++r) {
      const double temperature = random.uniform(290, 500);
      const double x = elementary::pow(10, random.uniform(-1, 1));
      const double law = 4e11 * x * x * elementary::exp(-6000 / temperature);
      table.columns[0].push_back(temperature);
      table.columns[1].push_back(x);
      table.target.push_back(noise(law, random));
      table.movement.push_back(r);
    }
    problem_.test = table;
    problem_.stages = {{"fit", {0, 1}, table}};
    task_.cell = {problem_.name, "front", "full", 1};
    task_.operators = find_operator_set("full");
  }

  const std::vector<double>& target() const { return problem_.stages.front().train.target; }

  Problem problem_;
  CellTask task_;
  std::vector<double> weights_;
  TwoFronts method_{{"3*x", "1e-23*x^2*(T - 200)^10"}, {"2", "26.7 + 2.01*ln_x - 6000/T"}};
};

TEST_F(DecadesFitTest, FindsInTheLogarithmWhatTheLargestRowsDoNotShow) {
  make([](double law, RandomStream& random) { return law * (1 + 0.03 * random.normal()); });
  ASSERT_TRUE(lies_over_decades(target()));
  const CellResult result = fit_over_decades(problem_, method_, task_, {}, weights_);
  EXPECT_THAT(method_.searches, ::testing::ElementsAre("target", "logarithm"));
  ASSERT_TRUE(is_ok(result.record));
  EXPECT_EQ(weights_.size(), target().size());
  EXPECT_THAT(result.record.note, ::testing::HasSubstr("relative errors"));
  // In the target's own terms: a power, of a whole number, and an exponential.
  EXPECT_THAT(result.record.formula, ::testing::HasSubstr("exp("));
  EXPECT_THAT(result.record.formula, ::testing::HasSubstr("x^2"));
  EXPECT_THAT(result.record.formula, ::testing::Not(::testing::HasSubstr("x^2.")));
  EXPECT_THAT(result.record.formula, ::testing::Not(::testing::HasSubstr("ln_x")));
  EXPECT_THAT(result.record.formula, ::testing::Not(::testing::HasSubstr("log(")));
  EXPECT_GT(result.record.evaluations, 150U);  // of both searches
}

TEST_F(DecadesFitTest, LeavesNoiseOfOneSizeToTheFirstSearch) {
  make([](double law, RandomStream& random) { return 3 * (law / 1e6 + 0.2) + random.normal(); });
  const CellResult result = fit_over_decades(problem_, method_, task_, {}, weights_);
  ASSERT_TRUE(is_ok(result.record));
  EXPECT_TRUE(weights_.empty());
  EXPECT_THAT(result.record.formula, ::testing::Not(::testing::HasSubstr("exp(")));
}

TEST_F(DecadesFitTest, EndsWithALawThatIsExact) {
  make([](double law, RandomStream&) { return law; });
  const TwoFronts exact({"4e11*x^2*exp(-6000/T)"}, {"2"});
  const CellResult result = fit_over_decades(problem_, exact, task_, {}, weights_);
  EXPECT_THAT(exact.searches, ::testing::ElementsAre("target"));
  EXPECT_TRUE(is_ok(result.record));
}

// A template says what the target looks like.
TEST_F(DecadesFitTest, LeavesAFormOfTheUsersAsItIs) {
  make([](double law, RandomStream& random) { return law * (1 + 0.03 * random.normal()); });
  TwoFronts form({"4.1e11*x^2.01*exp(-6000/T)"}, {"2"});
  form.keeps_form = true;
  const CellResult result = fit_over_decades(problem_, form, task_, {}, weights_);
  EXPECT_THAT(form.searches, ::testing::ElementsAre("target"));
  EXPECT_FALSE(weights_.empty());
  const Expression fitted = parse(result.record.formula, std::vector<std::string>{"T", "x"});
  const Expression given = parse("4.1e11*x^2.01*exp(-6000/T)", std::vector<std::string>{"T", "x"});
  EXPECT_EQ(fitted.size(), given.size()) << result.record.formula;
  EXPECT_THAT(result.record.formula, ::testing::HasSubstr("x^2.0"));
}

TEST(LiesOverDecades, IsSaidOfValuesOfOneSignThatDifferByFactors) {
  std::vector<double> wide;
  std::vector<double> narrow;
  for (int i = 0; i < 100; ++i) {
    wide.push_back(-elementary::pow(10, 0.06 * i));
    narrow.push_back(1 + 0.05 * i);
  }
  EXPECT_TRUE(lies_over_decades(wide));
  EXPECT_FALSE(lies_over_decades(narrow));
  wide.back() = 1;
  EXPECT_FALSE(lies_over_decades(wide));
  wide.back() = 0;
  EXPECT_FALSE(lies_over_decades(wide));
}

}  // namespace
}  // namespace tribench
