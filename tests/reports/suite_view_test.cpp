// SPDX-License-Identifier: MIT
#include "reports/suite_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

Record record(const std::string& problem, const std::string& method, std::uint64_t seed,
              double r2_test) {
  Record one;
  one.problem = problem;
  one.method = method;
  one.operators = std::string("full");
  one.seed = seed;
  one.status = CellStatus::ok;
  one.r2_test = r2_test;
  one.fit_cpu_s = 2;
  one.fit_wall_s = 3;
  one.evaluations = 100;
  return one;
}

SuiteInfo small_suite() {
  return {"s",
          "three laws",
          1e-7,
          "read with care",
          {{"s/a", "x", 1}, {"s/b", "x*y", 3}, {"s/c", "x*y+exp(x)", 6}},
          {{"theirs", 1, 0.2, 0.1, 0.3}, {"theirs", 9, 0.6, 0.5, 0.7}}};
}

// a: both seeds recovered; b: one of two; c: failed and missed.
std::vector<Record> small_records() {
  Record failed = record("s/c", "m", 1, kMissing);
  failed.status = CellStatus::failed;
  return {record("s/a", "m", 1, 1),
          record("s/a", "m", 2, 1 - 1e-9),
          record("s/b", "m", 1, 1 - 1e-8),
          record("s/b", "m", 2, 0.9995),
          failed,
          record("s/c", "m", 2, 0.95),
          record("other/a", "m", 1, 1)};
}

TEST(SuiteView, CountsWhatWasRecoveredByHand) {
  const std::vector<SuiteView> views = view_suites({small_suite()}, small_records());
  ASSERT_EQ(views.size(), 1U);
  ASSERT_EQ(views[0].rows.size(), 1U);
  const SuiteMethodRow& row = views[0].rows[0];
  EXPECT_EQ(row.problems, 3U);
  EXPECT_EQ(row.cells, 6U);
  EXPECT_EQ(row.failed, 1U);
  EXPECT_DOUBLE_EQ(row.recovered, (1 + 0.5 + 0) / 3);
  EXPECT_DOUBLE_EQ(row.r2_at_least[0], 2.0 / 3);
  EXPECT_DOUBLE_EQ(row.r2_at_least[2], (1 + 1 + 0.5) / 3);
  EXPECT_LE(row.interval.low, row.recovered);
  EXPECT_GE(row.interval.high, row.recovered);
  EXPECT_DOUBLE_EQ(row.recovered_by_size[0], 1);
  EXPECT_DOUBLE_EQ(row.recovered_by_size[1], 0.5);
  EXPECT_DOUBLE_EQ(row.recovered_by_size[2], 0);
  EXPECT_EQ(views[0].never_solved, std::vector<std::string>{"s/c"});
}

TEST(SuiteView, AFewProblemsAreNoCertainty) {
  const std::vector<SuiteView> views =
      view_suites({small_suite()}, {record("s/a", "m", 1, 1), record("s/a", "m", 2, 1)});
  EXPECT_EQ(views[0].rows[0].recovered, 1);
  EXPECT_LT(views[0].rows[0].interval.low, 0.3);
  EXPECT_EQ(views[0].rows[0].interval.high, 1);
}

TEST(SuiteView, NoiseThatASweepAddsIsAnotherQuestion) {
  const std::vector<SuiteView> views = view_suites(
      {small_suite()}, {record("s/a", "m", 1, 1), record("s/a~noise=0.2", "m", 1, 0.9)});
  ASSERT_EQ(views[0].rows.size(), 2U);
  EXPECT_EQ(views[0].rows[0].recovered, 1);
  EXPECT_EQ(views[0].rows[1].recovered, 0);
  EXPECT_THAT(views[0].rows[1].operators, ::testing::EndsWith("~noise=0.2"));
  EXPECT_EQ(views[0].rows[1].recovered_by_size[0], 0);
  EXPECT_TRUE(views[0].never_solved.empty());
}

TEST(SuiteView, CellsThatFailedAreInTheMedian) {
  std::vector<Record> records = {record("s/a", "m", 1, 0.9), record("s/b", "m", 1, 0.5),
                                 record("s/c", "m", 1, kMissing)};
  records[2].status = CellStatus::failed;
  EXPECT_EQ(view_suites({small_suite()}, records)[0].rows[0].r2_median, 0.5);
}

TEST(SuiteView, AConstantLawIsRecoveredByItsValue) {
  SuiteInfo suite = small_suite();
  suite.problems = {{"s/seven", "7", 1}};
  std::vector<Record> records = {record("s/seven", "exact", 1, kMissing),
                                 record("s/seven", "near", 1, kMissing)};
  records[0].relative_error_test = 1e-13;
  records[1].relative_error_test = 4;
  const std::vector<SuiteView> views = view_suites({suite}, records);
  ASSERT_EQ(views[0].rows.size(), 2U);
  EXPECT_EQ(views[0].rows[0].method, "exact");
  EXPECT_EQ(views[0].rows[0].recovered, 1);
  EXPECT_EQ(views[0].rows[1].recovered, 0);
  EXPECT_EQ(views[0].rows[1].r2_at_least[0], 0);
  EXPECT_EQ(views[0].rows[1].r2_at_least[1], 1);  // 0.04^2 of the square are left
  EXPECT_TRUE(views[0].never_solved.empty());
}

TEST(SuiteView, ASuiteThatTheRunDoesNotHaveIsLeftOut) {
  SuiteInfo other = small_suite();
  other.name = "another";
  EXPECT_TRUE(view_suites({other}, small_records()).empty());
}

TEST(SuiteView, TheTextHasOursThePublishedAndTheUnsolved) {
  const std::string text = suites_markdown(view_suites({small_suite()}, small_records()), "###");
  for (const char* part : {"### s: three laws", "50.0 %", "theirs", "60.0 %", "read with care",
                           "- s/c: `x*y+exp(x)`"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
  }
  const nlohmann::ordered_json json =
      suite_views_json(view_suites({small_suite()}, small_records()));
  EXPECT_EQ(json[0]["rows"][0]["recovered"], 0.5);
  EXPECT_EQ(json[0]["never_solved"][0], "s/c");
}

TEST(SuiteView, SuitesReadBackAndDamageIsSaid) {
  const std::filesystem::path folder = fresh_folder("suite_view");
  std::ofstream(folder / kSuiteFile) << suites_json({small_suite()});
  std::vector<std::string> complaints;
  const std::vector<SuiteInfo> read = read_suites(folder / kSuiteFile, complaints);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].problems[2].nodes, 6);
  EXPECT_EQ(read[0].references[1].recovered, 0.6);
  EXPECT_TRUE(complaints.empty());
  std::ofstream(folder / kSuiteFile) << "[{\"name\": 1";
  EXPECT_TRUE(read_suites(folder / kSuiteFile, complaints).empty());
  EXPECT_EQ(complaints.size(), 1U);
  EXPECT_TRUE(read_suites(folder / "none.json", complaints).empty());
}

}  // namespace
}  // namespace tribench
