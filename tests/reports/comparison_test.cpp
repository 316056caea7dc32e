// SPDX-License-Identifier: MIT
#include "reports/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "foundation/random.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

constexpr int kProblems = 4;

struct Planted {
  double error = 1;  // factor on the error of "b"
  double time = 1;   // factor on its CPU seconds
};

// Methods a, b, c on four problems. Errors spread by 5 % over seeds; `noise` keys what differs
// between two runs of identical code, 2 % more.
RunFolder noisy_run(const std::string& noise, std::uint64_t seeds, Planted planted = {}) {
  RunFolder run;
  run.path = noise;
  run.provenance = {{"sessions.0.machine.cpu", "x"},
                    {"sessions.0.calibration.samples.0.cpu_s", "0.02"},
                    {"sessions.0.calibration.samples.1.cpu_s", "0.0201"}};
  for (int problem = 0; problem < kProblems; ++problem) {
    for (const std::string method : {"a", "b", "c"}) {
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Record record;
        record.problem = "p" + std::to_string(problem);
        record.method = method;
        record.operators = "paper";
        record.seed = seed;
        record.cell = record.problem + "|" + method + "|paper|" + std::to_string(seed);
        record.status = "ok";
        record.formula = "x";
        RandomStream own(key_of(record.cell));
        RandomStream random(key_of(record.cell + noise));
        record.mae_test = std::exp(0.05 * own.normal() + 0.02 * random.normal()) *
                          (method == "b" ? planted.error : 1);
        record.fit_cpu_s = std::exp(0.03 * random.normal()) * (method == "b" ? planted.time : 1);
        run.records.push_back(record);
      }
    }
  }
  return run;
}

const ComparisonRow& pooled(const std::vector<ComparisonRow>& rows, const std::string& method) {
  for (const ComparisonRow& row : rows) {
    if (row.method == method && row.problem.empty()) return row;
  }
  throw std::runtime_error("no such row");
}

TEST(Comparison, FindsNothingBetweenARunAndItself) {
  const RunFolder run = noisy_run("x", 5);
  const Comparison comparison = compare_runs(run, run);
  EXPECT_EQ(comparison.identical, comparison.common);
  EXPECT_FALSE(comparison.has_regression());
  EXPECT_THAT(comparison.sentence(), HasSubstr("identical apart from time"));
  EXPECT_EQ(pooled(comparison.quality, "a").verdict, ComparisonVerdict::equivalent);
}

TEST(Comparison, FindsAMethodMadeThreePerCentWorseWithTwentySeeds) {
  int found = 0;
  for (int study = 0; study < 20; ++study) {
    const std::string name = std::to_string(study);
    const Comparison comparison =
        compare_runs(noisy_run("base" + name, 20), noisy_run("new" + name, 20, {1.03, 1}));
    found += pooled(comparison.quality, "b").verdict == ComparisonVerdict::worse ? 1 : 0;
    EXPECT_NE(pooled(comparison.quality, "a").verdict, ComparisonVerdict::worse);
  }
  EXPECT_EQ(found, 20);
}

TEST(Comparison, AlwaysFindsThreePerCentWhereTheSeedsAreTheSame) {
  const Comparison comparison = compare_runs(noisy_run("x", 20), noisy_run("x", 20, {1.03, 1}));
  EXPECT_EQ(pooled(comparison.quality, "b").verdict, ComparisonVerdict::worse);
  EXPECT_NEAR(pooled(comparison.quality, "b").ratio, 1.03, 1e-9);
  EXPECT_TRUE(comparison.has_regression());
  const Comparison back = compare_runs(noisy_run("x", 20, {1.03, 1}), noisy_run("x", 20));
  EXPECT_EQ(pooled(back.quality, "b").verdict, ComparisonVerdict::better);
  EXPECT_FALSE(back.has_regression());
}

TEST(Comparison, CallsAChangeBelowOnePerCentEquivalent) {
  const Comparison comparison = compare_runs(noisy_run("x", 20), noisy_run("x", 20, {1.005, 1}));
  EXPECT_EQ(pooled(comparison.quality, "b").verdict, ComparisonVerdict::equivalent);
  EXPECT_FALSE(comparison.has_regression());
}

TEST(Comparison, FindsAMethodMadeTenPerCentSlowerUnlessTheMachineExplainsIt) {
  const RunFolder base = noisy_run("base", 20);
  RunFolder slower = noisy_run("new", 20, {1, 1.10});
  EXPECT_EQ(pooled(compare_runs(base, slower).time, "b").verdict, ComparisonVerdict::worse);
  EXPECT_NE(pooled(compare_runs(base, slower).time, "a").verdict, ComparisonVerdict::worse);

  RunFolder slow_machine = noisy_run("new", 20, {1, 1});
  for (Record& record : slow_machine.records) record.fit_cpu_s *= 1.3;
  slow_machine.provenance[1].second = "0.026";
  slow_machine.provenance[2].second = "0.02613";
  EXPECT_EQ(pooled(compare_runs(base, slow_machine).time, "b").verdict,
            ComparisonVerdict::equivalent);
}

TEST(Comparison, RefusesToCompareTimesWhereTheCalibrationForbidsIt) {
  const RunFolder base = noisy_run("base", 5);
  RunFolder now = noisy_run("new", 5);
  now.provenance[2].second = "0.03";
  EXPECT_THAT(compare_runs(base, now).why_no_time, HasSubstr("pace changed by 50 %"));
  now.provenance.clear();
  EXPECT_THAT(compare_runs(base, now).why_no_time, HasSubstr("no calibration"));
  now = noisy_run("new", 5);
  now.provenance[0].second = "y";
  EXPECT_EQ(compare_runs(base, now).why_no_time, "the CPUs differ");
}

TEST(Comparison, ACrashIsARegressionAndASingleTimeoutIsNot) {
  const RunFolder base = noisy_run("x", 20);
  RunFolder now = base;
  now.records[3].status = "failed";
  now.records[3].reason = "timeout";
  EXPECT_FALSE(compare_runs(base, now).has_regression());
  now.records[3].reason = "crashed (SIGSEGV)";
  EXPECT_TRUE(compare_runs(base, now).has_regression());
  for (std::size_t i = 0; i < 12; ++i) {
    now.records[i].status = "failed";
    now.records[i].reason = "timeout";
  }
  EXPECT_TRUE(compare_runs(base, now).has_regression());
}

TEST(Comparison, CountsCellsThatOnlyOneRunHas) {
  const RunFolder base = noisy_run("x", 3);
  RunFolder now = base;
  now.records.pop_back();
  now.records[0].cell += "0";
  now.records[1].singularity = "refuted";
  const Comparison comparison = compare_runs(base, now);
  EXPECT_EQ(comparison.only_base, 2U);
  EXPECT_EQ(comparison.only_new, 1U);
  EXPECT_EQ(comparison.newly_singular, (std::vector<std::string>{base.records[1].cell}));
  EXPECT_THAT(comparison_markdown(comparison), HasSubstr("Newly singular (1)"));
  EXPECT_EQ(comparison_json(comparison)["only_base"], 2);
}

}  // namespace
}  // namespace tribench
