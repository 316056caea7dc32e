// SPDX-License-Identifier: MIT
#include "reports/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

Record cell(const std::string& method, std::uint64_t seed, double error) {
  Record record;
  record.cell = "p|" + method + "|paper|" + std::to_string(seed);
  record.problem = "p";
  record.method = method;
  record.operators = "paper";
  record.seed = seed;
  record.status = std::isnan(error) ? CellStatus::failed : CellStatus::ok;
  record.reason.kind = std::isnan(error) ? FailureKind::timeout : FailureKind::none;
  record.mae_test = error;
  record.complexity = 5;
  record.formula = std::isnan(error) ? "" : "x";
  return record;
}

const MethodRow& row_of(const ProblemTable& table, const std::string& method) {
  for (const MethodRow& row : table.rows) {
    if (row.method == method) return row;
  }
  throw std::runtime_error("no such row");
}

TEST(Summary, TellsBehindFromNotDistinguishableFromPracticallyEqual) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto s = static_cast<double>(seed);
    run.records.push_back(cell("best", seed, 1 + 0.01 * s));
    run.records.push_back(cell("equal", seed, (1 + 0.01 * s) * 1.005));
    run.records.push_back(cell("unclear", seed, seed % 2 == 0 ? 1.4 : 0.9));
    run.records.push_back(cell("worse", seed, 1.5 + 0.01 * s));
  }
  const RunSummary summary = summarise(run);
  ASSERT_EQ(summary.tables.size(), 1U);
  const ProblemTable& table = summary.tables[0];
  EXPECT_EQ(row_of(table, "best").standing, Standing::best);
  EXPECT_EQ(row_of(table, "equal").standing, Standing::equivalent);
  EXPECT_EQ(row_of(table, "unclear").standing, Standing::not_distinguishable);
  EXPECT_EQ(row_of(table, "worse").standing, Standing::behind);
  EXPECT_THAT(reading_of(table), HasSubstr("unclear is not distinguishable from it"));
}

TEST(Summary, CallsNothingEqualThatFailsOrIsFarOffOnSomeSeeds) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const double error = 1 + 0.1 * static_cast<double>(seed);
    run.records.push_back(cell("best", seed, error));
    run.records.push_back(cell("flaky", seed, seed > 3 ? std::nan("") : error));
    run.records.push_back(cell("same", seed, error * 1.004));
    run.records.push_back(cell("split", seed, seed > 3 ? 149 * error : error));
  }
  const RunSummary summary = summarise(run);
  EXPECT_EQ(row_of(summary.tables[0], "same").standing, Standing::equivalent);
  EXPECT_EQ(row_of(summary.tables[0], "split").standing, Standing::not_distinguishable);
  EXPECT_EQ(row_of(summary.tables[0], "flaky").standing, Standing::not_distinguishable);
}

// A shard of a run has some seeds of one method and others of another.
TEST(Summary, SaysNothingOfMethodsWithoutACommonSeed) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    run.records.push_back(cell(seed % 2 == 0 ? "even" : "odd", seed, 1));
  }
  const ProblemTable table = summarise(run).tables[0];
  EXPECT_EQ(row_of(table, "odd").standing, Standing::not_distinguishable);
  EXPECT_EQ(row_of(table, "odd").pairs, 0U);
}

TEST(Summary, TakesWhatRepeatsToTheLastDigitForOneDraw) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    run.records.push_back(cell("better", seed, 1));
    run.records.push_back(cell("worse", seed, 1.69));
  }
  const RunSummary summary = summarise(run);
  EXPECT_EQ(row_of(summary.tables[0], "worse").standing, Standing::behind_untested);
  EXPECT_THAT(reading_of(summary.tables[0]), HasSubstr("10 seeds repeat 1 result"));
}

TEST(Summary, TakesErrorsOfRoundingAloneForEqual) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto s = static_cast<double>(seed);
    run.records.push_back(cell("exact", seed, 0));
    run.records.push_back(cell("last bit", seed, 4.6e-17 * s));
    run.records.push_back(cell("near", seed, 1e-9 * s));
  }
  for (Record& record : run.records) record.relative_error_test = 100 * record.mae_test / 3;
  const ProblemTable table = summarise(run).tables[0];
  EXPECT_EQ(row_of(table, "last bit").standing, Standing::equivalent);
  EXPECT_EQ(row_of(table, "last bit").placed_by, 0);
  EXPECT_EQ(row_of(table, "near").standing, Standing::behind);
}

// Least squares that ends without a formula on the seed that is hardest.
TEST(Summary, FailingOnAHardSeedMakesNoMedianSmaller) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto s = static_cast<double>(seed);
    run.records.push_back(cell("plain", seed, s));
    run.records.push_back(cell("cherry", seed, seed == 5 ? std::nan("") : s));
  }
  const ProblemTable table = summarise(run).tables[0];
  EXPECT_EQ(row_of(table, "cherry").mae_test.middle, row_of(table, "plain").mae_test.middle);
  EXPECT_EQ(table.rows.front().method, "plain");
}

TEST(Summary, SaysThatTwoSeedsAreTooFewForATest) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    run.records.push_back(cell("good", seed, static_cast<double>(seed)));
    run.records.push_back(cell("bad", seed, 2 * static_cast<double>(seed)));
  }
  const RunSummary summary = summarise(run);
  EXPECT_EQ(row_of(summary.tables[0], "bad").standing, Standing::behind_untested);
  EXPECT_THAT(reading_of(summary.tables[0]), HasSubstr("2 seeds are too few for a test"));
}

TEST(Summary, PlacesAFailedCellLastInsteadOfLeavingItOut) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    run.records.push_back(cell("steady", seed, 2));
    run.records.push_back(cell("lucky", seed, seed == 1 ? 1 : std::nan("")));
  }
  const RunSummary summary = summarise(run);
  const ProblemTable& table = summary.tables[0];
  EXPECT_EQ(table.rows.front().method, "steady");
  EXPECT_EQ(row_of(table, "lucky").standing, Standing::failed);
  EXPECT_EQ(row_of(table, "lucky").failed, 2U);
  EXPECT_THAT(reading_of(table), HasSubstr("lucky failed in 2 of 3 cells"));
}

// A pole that a test row meets makes the cell fail: it is a pole all the same.
TEST(Summary, CountsThePolesOfFailedCellsToo) {
  RunFolder run;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    run.records.push_back(cell("smooth", seed, 2));
    run.records.push_back(cell("pole", seed, seed == 1 ? 1 : std::nan("")));
    run.records.back().singularity = seed == 1 ? Singularity::proved_free : Singularity::refuted;
  }
  const RunSummary summary = summarise(run);
  EXPECT_EQ(row_of(summary.tables[0], "pole").refuted, 2U);
  EXPECT_THAT(reading_of(summary.tables[0]), HasSubstr("pole (2 of 3)"));
}

TEST(Summary, SetsAFixedFormBesideEveryOperatorSet) {
  RunFolder run;
  run.records = sample_records(2);
  std::sort(run.records.begin(), run.records.end(), [](const Record& a, const Record& b) {
    return std::tie(a.problem, a.method, a.operators, a.seed) <
           std::tie(b.problem, b.method, b.operators, b.seed);
  });
  const RunSummary summary = summarise(run);
  EXPECT_EQ(summary.operators, (std::vector<std::string>{"paper", "paper+div"}));
  ASSERT_EQ(summary.tables.size(), 4U);
  for (const ProblemTable& table : summary.tables) row_of(table, "symmetric");
  EXPECT_EQ(summary.failures.size(), 2U);
  EXPECT_EQ(row_of(summary.tables[1], "pysr").refuted, 1U);
  EXPECT_EQ(row_of(summary.tables[1], "pysr").singular->seed, 2U);
}

}  // namespace
}  // namespace tribench
