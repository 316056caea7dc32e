// SPDX-License-Identifier: MIT
#include "harness/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "foundation/error.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

TEST(FullCatalogue, NguyensProblemsHaveThePublishedRowsAndRanges) {
  const Catalogue catalogue = full_catalogue();
  for (int number = 1; number <= 12; ++number) {
    const ProblemEntry& entry = catalogue.find("nguyen/" + std::to_string(number));
    const Problem problem = entry.make(1);
    const Table& train = problem.stages[0].train;
    EXPECT_EQ(train.rows(), 20U);
    for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
      for (const double x : train.columns[j]) {
        EXPECT_GE(x, problem.inputs[j].low);
        EXPECT_LE(x, problem.inputs[j].high);
      }
    }
    EXPECT_NE(entry.make(2).stages[0].train.target, train.target);
    EXPECT_EQ(entry.make(1).stages[0].train.target, train.target);
  }
  // Nguyen-7 at a point worked by hand: log(2) + log(2) at x = 1.
  const Problem seventh = catalogue.find("nguyen/7").make(1);
  for (std::size_t r = 0; r < seventh.test.rows(); ++r) {
    const double x = seventh.test.columns[0][r];
    EXPECT_NEAR(std::exp(seventh.test.target[r]), (x + 1) * (x * x + 1), 1e-12);
  }
}

// Every law of every shipped suite parses over its inputs and is finite where it is drawn.
TEST(FullCatalogue, EveryShippedLawHasItsRows) {
  const Catalogue catalogue = full_catalogue();
  std::size_t laws = 0;
  for (const suite::Suite& suite : catalogue.suites()) {
    for (const suite::SuiteProblem& one : suite.problems) {
      if (!one.file.empty() || one.rows > 5000) continue;
      const Problem problem = catalogue.find(suite.name + "/" + one.name).make(1);
      ASSERT_GE(problem.stages[0].train.rows(), 9U) << problem.name;
      ASSERT_GE(problem.test.rows(), 100U) << problem.name;
      for (const Table* table : {&problem.stages[0].train, &problem.test}) {
        for (std::size_t r = 0; r < table->rows(); ++r) {
          ASSERT_TRUE(std::isfinite(table->target[r])) << problem.name;
          for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
            const Input& box = problem.inputs[j];
            const double slack = 1e-12 * std::max(std::abs(box.low), std::abs(box.high));
            ASSERT_GE(table->columns[j][r], box.low - slack) << problem.name;
            ASSERT_LE(table->columns[j][r], box.high + slack) << problem.name;
          }
        }
      }
      EXPECT_EQ(problem.true_law(), one.law);
      ++laws;
    }
  }
  EXPECT_EQ(laws, 12U + 22 + 14 + 14 + 100 + 120 + 80);
}

// Two independent writings of the Feynman equations: with constants as inputs (feynman) and as
// numbers (fastsrb). Here those without any constant must give the same value.
TEST(FullCatalogue, FeynmansLawsAgreeWithTheirFastsrbForms) {
  const Catalogue catalogue = full_catalogue();
  const auto suite_of = [&](const char* name) -> const suite::Suite& {
    return *std::ranges::find(catalogue.suites(), std::string(name), &suite::Suite::name);
  };
  const suite::Suite& natural = suite_of("fastsrb");
  std::size_t compared = 0;
  for (const suite::SuiteProblem& own : suite_of("feynman").problems) {
    const auto other = std::ranges::find(natural.problems, own.name, &suite::SuiteProblem::name);
    ASSERT_NE(other, natural.problems.end()) << own.name;
    if (other->inputs.size() != own.inputs.size()) continue;
    std::set<std::string> meanings;
    for (const suite::SuiteInput& input : other->inputs) meanings.insert(input.meaning);
    const bool same_inputs = std::ranges::all_of(
        own.inputs, [&](const suite::SuiteInput& input) { return meanings.contains(input.name); });
    if (!same_inputs) continue;
    // Rows of our own form, told to the other form input by input.
    const Problem problem = catalogue.find("feynman/" + own.name).make(1);
    suite::Suite one_law;
    one_law.name = "told";
    suite::SuiteProblem told = *other;
    for (suite::SuiteInput& input : told.inputs) {
      const auto mine = std::ranges::find(own.inputs, input.meaning, &suite::SuiteInput::name);
      const double value =
          problem.test.columns[static_cast<std::size_t>(mine - own.inputs.begin())][0];
      input.test = input.train = {suite::Draw::Kind::uniform, value, std::nextafter(value, 1e300)};
    }
    told.rows = told.test_rows = 1;
    one_law.problems = {told};
    const auto expected = problem.test.target[0];
    const auto value = suite::make_suite_problem(one_law, told, law_reader(), {}, 1).test.target[0];
    EXPECT_NEAR(value / expected, 1, 1e-9) << own.name;
    ++compared;
  }
  EXPECT_GE(compared, 40U);
}

// Shared tables, where they are there: SRBench's splits are disjoint quarters of all rows.
TEST(FullCatalogue, TablesAreSplitAndStandardised) {
  const std::filesystem::path suites = testing::source_dir() / "../shared/suites";
  if (!std::filesystem::exists(suites)) GTEST_SKIP() << testing::kNoSharedData;
  const Catalogue catalogue = full_catalogue(suites);
  const Problem cloud = catalogue.find("srbench_blackbox/210_cloud").make(1);
  EXPECT_EQ(cloud.stages[0].train.rows() + cloud.test.rows(), 108U);
  EXPECT_EQ(cloud.test.rows(), 27U);
  double mean = 0;
  for (const double y : cloud.stages[0].train.target) mean += y / 81;
  EXPECT_NEAR(mean, 0, 1e-12);
  EXPECT_NE(catalogue.find("srbench_blackbox/210_cloud").make(2).test.target, cloud.test.target);
  const Problem kepler = catalogue.find("first_principles/kepler").make(1);
  EXPECT_EQ(kepler.stages[0].train.rows(), 4U);
  EXPECT_EQ(kepler.true_law(), "366.651*(a^1.5)");
  EXPECT_THROW(full_catalogue().find("first_principles/kepler").make(1), Error);
}

}  // namespace
}  // namespace tribench
