// SPDX-License-Identifier: MIT
#include "reports/suite_ranks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace tribench {
namespace {

Record record(const std::string& problem, double r2_test, double seconds = 2) {
  Record one;
  one.problem = problem;
  one.method = std::string("m");
  one.operators = std::string("full");
  one.status = std::isnan(r2_test) ? CellStatus::failed : CellStatus::ok;
  one.r2_test = r2_test;
  one.fit_cpu_s = seconds;
  return one;
}

// Three methods on two tables, one of them without a formula.
std::vector<SuiteResult> published() {
  return {{"s/a", "tree", false, 0.9, 5},      {"s/a", "gp", true, 0.8, 100},
          {"s/a", "old", true, 0.2, kMissing}, {"s/b", "tree", false, 0.5, 15},
          {"s/b", "gp", true, 0.7, 300},       {"s/b", "old", true, 0.1, kMissing}};
}

TEST(SuiteRanks, CountsWhoIsBetterOnEachTableByHand) {
  const SuiteRanks ranks = rank_among_published(
      published(), {record("s/a", 0.85, 1), record("s/b", 0.4, 3), record("other/a", 1)});
  ASSERT_EQ(ranks.tables.size(), 2U);
  EXPECT_EQ(ranks.tables[0].rank, 2U);           // behind tree
  EXPECT_EQ(ranks.tables[0].symbolic_rank, 1U);  // of the formulas nobody is better
  EXPECT_EQ(ranks.tables[1].rank, 3U);           // behind gp and tree
  EXPECT_EQ(ranks.tables[1].symbolic_rank, 2U);
  EXPECT_EQ(ranks.best[0].method, "tree");
  EXPECT_EQ(ranks.best_symbolic[0].method, "gp");
}

TEST(SuiteRanks, OursAmongThePublishedAndThoseAmongThemselves) {
  const SuiteRanks ranks =
      rank_among_published(published(), {record("s/a", 0.85, 1), record("s/b", 0.4, 3)});
  ASSERT_EQ(ranks.methods.size(), 4U);
  EXPECT_EQ(ranks.methods[0].method, "gp");  // ranks 2 and 1
  EXPECT_EQ(ranks.methods[0].rank_median, 1.5);
  EXPECT_EQ(ranks.methods[0].symbolic_rank_median, 1);
  EXPECT_EQ(ranks.methods[0].seconds, 200);
  EXPECT_TRUE(ranks.methods[0].operators.empty());
  EXPECT_EQ(ranks.methods[1].method, "tree");  // ranks 1 and 2
  EXPECT_TRUE(std::isnan(ranks.methods[1].symbolic_rank_median));
  EXPECT_EQ(ranks.methods[2].method, "m");  // ranks 2 and 3 of four
  EXPECT_EQ(ranks.methods[2].rank_mean, 2.5);
  EXPECT_EQ(ranks.methods[2].seconds, 2);
}

// The middle of the seeds; a failed cell is below all others.
TEST(SuiteRanks, AMedianOverSeedsInWhichFailedCellsCount) {
  const auto table = [](const std::vector<Record>& records) {
    return rank_among_published(published(), records).tables.at(0);
  };
  EXPECT_EQ(table({record("s/a", 0.1), record("s/a", 0.95), record("s/a", 0.3)}).r2, 0.3);
  EXPECT_EQ(table({record("s/a", kMissing), record("s/a", 0.95), record("s/a", 0.3)}).r2, 0.3);
  EXPECT_EQ(table({record("s/a", 0.25), record("s/a", 0.75)}).r2, 0.5);
  const TableRank failed =
      table({record("s/a", kMissing), record("s/a", kMissing), record("s/a", 1)});
  EXPECT_FALSE(failed.r2);
  EXPECT_EQ(failed.rank, 4U);
}

TEST(SuiteRanks, NoRanksAmongDifferentMethods) {
  std::vector<SuiteResult> some = published();
  some.pop_back();  // `old` has no figure on s/b
  const SuiteRanks ranks = rank_among_published(some, {record("s/a", 0.85), record("s/b", 0.4)});
  EXPECT_EQ(ranks.tables.size(), 2U);
  EXPECT_TRUE(ranks.methods.empty());
}

TEST(SuiteRanks, TheTextAndTheJsonHaveBothSides) {
  const SuiteRanks ranks =
      rank_among_published(published(), {record("s/a", 0.85), record("s/b", 0.4)});
  const std::string text = suite_ranks_markdown(ranks);
  for (const char* part :
       {"over 2 tables", "**m**", "| gp", "0.850 (1, 2)", "0.800 (gp)", "0.900 (tree)"}) {
    EXPECT_THAT(text, ::testing::HasSubstr(part));
  }
  const nlohmann::ordered_json json = suite_ranks_json(ranks);
  EXPECT_EQ(json["tables"][1]["symbolic_rank"], 2);
  EXPECT_EQ(json["methods"][0]["method"], "gp");
  EXPECT_EQ(suite_ranks_markdown(rank_among_published({}, {record("s/a", 1)})), "");
}

TEST(SuiteRanks, PublishedResultsReadBack) {
  const std::vector<SuiteResult> read =
      suite_results_in(nlohmann::json::parse(suite_results_json(published()).dump()));
  ASSERT_EQ(read.size(), published().size());
  EXPECT_EQ(read[1].method, "gp");
  EXPECT_EQ(read[1].seconds, 100);
  EXPECT_FALSE(read[0].symbolic);
  EXPECT_TRUE(std::isnan(read[2].seconds));
}

}  // namespace
}  // namespace tribench
