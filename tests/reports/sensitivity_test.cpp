// SPDX-License-Identifier: MIT
#include "reports/sensitivity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/output_file.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/run_folder.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

// Methods a, b, c on three problems with four seeds. By MAE a leads; by the largest error c does;
// on problem "r" b is ahead; on seeds 3 and 4 b leads. Only c has a formula before a hundredth of
// the budget.
RunFolder planted() {
  RunFolder run;
  run.path = fresh_folder("sensitivity");
  std::vector<TraceRecord> trace;
  for (const std::string problem : {"p", "q", "r"}) {
    for (const std::string method : {"a", "b", "c"}) {
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Record r;
        r.problem = problem;
        r.method = method;
        r.operators = "paper";
        r.seed = seed;
        r.cell = problem + "|" + method + "|paper|" + std::to_string(seed);
        r.status = CellStatus::ok;
        const bool late = seed > 2;
        const double b = problem == "r" ? 0.5 : (late ? 0.9 : 2);
        r.mae_test = method == "a" ? 1 : (method == "b" ? b : 3);
        r.mae_train = r.mae_test;
        r.rmse_test = r.mae_test;
        r.max_error_test = method == "c" ? 1 : 2 * r.mae_test;
        r.evaluations = 1'000'000;
        if (method == "c") trace.push_back({r.cell, 900, 0, 9});
        trace.push_back({r.cell, 900'000, 0, r.mae_test});
        run.records.push_back(r);
      }
    }
  }
  write_file(run.path / "trace.csv", trace_csv(trace));
  return run;
}

const RankingVariation& find(const Sensitivity& of, const std::string& what) {
  for (const RankingVariation& each : of.variations) {
    if (each.what == what) return each;
  }
  throw std::out_of_range(what);
}

TEST(Sensitivity, FindsWhatTurnsThePlantedRankingAround) {
  const RunFolder run = planted();
  const RunSummary summary = summarise(run);
  const std::vector<Sensitivity> all = ranking_sensitivity(run, summary);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].leader, "a");
  EXPECT_DOUBLE_EQ(find(all[0], "root mean square error").least_tau, 1);
  const RankingVariation& largest = find(all[0], "largest error");
  EXPECT_EQ(largest.leaders.at("c"), 1U);
  EXPECT_LT(largest.least_tau, 0);
  const RankingVariation& halves = find(all[0], "half of the seeds");
  EXPECT_EQ(halves.count, 4U);
  EXPECT_GE(halves.leaders.at("b"), 1U);  // of seeds 3 and 4
  EXPECT_GE(halves.leaders.at("a"), 1U);  // of seeds 1 and 2
  EXPECT_EQ(find(all[0], "without one of the problems").count, 3U);
  EXPECT_EQ(find(all[0], "training error after 0.1 % of the budget").leaders.at("c"), 1U);
  EXPECT_EQ(find(all[0], "training error after the whole budget").leaders.at("a"), 1U);
  // The truth is known to none of them: no such ranking.
  EXPECT_THROW(find(all[0], "error to the truth"), std::out_of_range);
  EXPECT_THAT(reading_of(all[0]), HasSubstr("a leads in"));
  EXPECT_THAT(reading_of(all[0]), HasSubstr("largest error"));
  EXPECT_THAT(sensitivity_section(all), HasSubstr("| largest error"));
}

// An external program that claims all of its error gone at once, another one that says nothing.
TEST(Sensitivity, BelievesNoClaimThatTheJudgedFormulaContradicts) {
  RunFolder run = planted();
  std::vector<TraceRecord> trace;
  run.budget = 1'000'000;
  for (Record& record : run.records) {
    if (record.method == "b") {
      record.mae_train = record.mae_test = 50;
      trace.push_back({record.cell, 1, 0, -5});
      record.evaluations = 1'000'000'000'000;
    } else if (record.method == "c") {
      trace.push_back({record.cell, 400'000, 0, record.mae_test});
    }
  }
  write_file(run.path / "trace.csv", trace_csv(trace));
  const std::vector<Sensitivity> all = ranking_sensitivity(run, summarise(run));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(find(all[0], "training error after the whole budget").leaders.count("a"), 1U);
  EXPECT_THROW(find(all[0], "training error after 10 % of the budget").leaders.at("c"),
               std::out_of_range);
}

TEST(Sensitivity, HasNothingToSayOfOneProblem) {
  RunFolder run = planted();
  std::erase_if(run.records, [](const Record& r) { return r.problem != "p"; });
  const RunSummary summary = summarise(run);
  EXPECT_TRUE(ranking_sensitivity(run, summary).empty());
  EXPECT_EQ(sensitivity_section({}), "");
}

}  // namespace
}  // namespace tribench
