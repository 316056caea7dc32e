// SPDX-License-Identifier: MIT
#include "reports/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "foundation/random.hpp"
#include "tests/reports/sample_run.hpp"
#include "tests/support/run_program.hpp"

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
        record.status = CellStatus::ok;
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

// A method without chance on one split: a hundred seeds say no more than one.
TEST(Comparison, TakesWhatRepeatsToTheLastDigitForOneDraw) {
  RunFolder base = noisy_run("a", 20);
  std::erase_if(base.records, [](const Record& r) { return r.problem != "p0"; });
  for (Record& record : base.records) record.mae_test = 1;
  RunFolder now = base;
  for (Record& record : now.records) record.mae_test = record.method == "b" ? 1.06 : 1;
  const Comparison comparison = compare_runs(base, now);
  const ComparisonRow& row = pooled(comparison.quality, "b");
  EXPECT_EQ(row.verdict, ComparisonVerdict::not_distinguishable);
  EXPECT_EQ(row.p, 1);
  EXPECT_NEAR(row.ratio, 1.06, 1e-9);
}

TEST(Comparison, CallsAChangeBelowOnePerCentEquivalent) {
  const Comparison comparison = compare_runs(noisy_run("x", 20), noisy_run("x", 20, {1.005, 1}));
  EXPECT_EQ(pooled(comparison.quality, "b").verdict, ComparisonVerdict::equivalent);
  EXPECT_FALSE(comparison.has_regression());
}

TEST(Comparison, FindsAMethodMadeTenPerCentSlowerUnlessTheMachineExplainsIt) {
  const RunFolder base = noisy_run("base", 20);
  RunFolder slower = noisy_run("new", 20, {1, 1.10});
  EXPECT_EQ(pooled(compare_runs(base, slower).cost, "b").verdict, ComparisonVerdict::worse);
  EXPECT_NE(pooled(compare_runs(base, slower).cost, "a").verdict, ComparisonVerdict::worse);

  RunFolder slow_machine = noisy_run("new", 20, {1, 1});
  for (Record& record : slow_machine.records) record.fit_cpu_s *= 1.3;
  slow_machine.provenance[1].second = "0.026";
  slow_machine.provenance[2].second = "0.02613";
  EXPECT_EQ(pooled(compare_runs(base, slow_machine).cost, "b").verdict,
            ComparisonVerdict::equivalent);
}

// A machine that others use has a pace that changes: cost is judged all the same.
TEST(Comparison, JudgesCostInInstructionsOrEvaluationsWhereSecondsCannotBeTrusted) {
  const auto busy = [](const std::string& name) {
    RunFolder run = noisy_run(name, 20);
    run.provenance[2].second = "0.03";
    RandomStream random(key_of(name));
    for (Record& record : run.records) {
      record.fit_cpu_s *= 1 + random.uniform();
      record.evaluations = 1'000'000;
      record.fit_instructions = 1e10 * (1 + 1e-4 * random.uniform());
    }
    return run;
  };
  const RunFolder base = busy("base");
  RunFolder now = busy("new");
  const Comparison same = compare_runs(base, now);
  EXPECT_EQ(same.cost_currency, CostCurrency::instructions);
  EXPECT_EQ(pooled(same.cost, "b").verdict, ComparisonVerdict::equivalent);
  for (Record& record : now.records) {
    if (record.method == "b") record.fit_instructions *= 1.08;
  }
  const Comparison dearer = compare_runs(base, now);
  EXPECT_EQ(pooled(dearer.cost, "b").verdict, ComparisonVerdict::worse);
  EXPECT_EQ(pooled(dearer.cost, "a").verdict, ComparisonVerdict::equivalent);
  EXPECT_EQ(dearer.outcome(), ComparisonOutcome::regression);
  EXPECT_THAT(dearer.sentence(), HasSubstr("dearer in 1 of 3 (instructions)"));
  EXPECT_THAT(comparison_markdown(dearer), HasSubstr("Not CPU seconds: the machine's pace"));
  for (Record& record : now.records) {
    record.fit_instructions = kMissing;
    if (record.method == "c") record.evaluations = 1'200'000;
  }
  const Comparison evaluations = compare_runs(base, now);
  EXPECT_EQ(evaluations.cost_currency, CostCurrency::evaluations);
  EXPECT_EQ(pooled(evaluations.cost, "b").verdict, ComparisonVerdict::equivalent);
  EXPECT_EQ(pooled(evaluations.cost, "c").verdict, ComparisonVerdict::worse);
  EXPECT_THAT(comparison_markdown(evaluations), HasSubstr("Slower code is not seen"));
}

TEST(Comparison, RowsThatCannotDifferCostTheOthersNothing) {
  // Only "b" differs at all: its own rows are the family, not those of "a" and "c" nor of the cost.
  RunFolder base = noisy_run("x", 12);
  RunFolder now = noisy_run("x", 12, {1.3, 1});
  const double least = 2 / std::pow(2.0, 12);
  for (const ComparisonRow& row : compare_runs(base, now).quality) {
    if (row.method != "b") EXPECT_EQ(row.p, 1);
    if (row.method == "b") EXPECT_LE(row.p, least * (kProblems + 1) * (1 + 1e-9));
  }
}

TEST(Comparison, RefusesToCompareTimesWhereTheCalibrationForbidsIt) {
  const RunFolder base = noisy_run("base", 5);
  RunFolder now = noisy_run("new", 5);
  now.provenance[2].second = "0.03";
  EXPECT_THAT(compare_runs(base, now).why_no_seconds, HasSubstr("pace changed by 50 %"));
  now.provenance.clear();
  EXPECT_THAT(compare_runs(base, now).why_no_seconds, HasSubstr("no calibration"));
  now = noisy_run("new", 5);
  now.provenance[0].second = "y";
  EXPECT_EQ(compare_runs(base, now).why_no_seconds, "the CPUs differ");
  // Fits of a moment have no pace.
  RunFolder soon = base;
  for (Record& record : soon.records) {
    record.fit_cpu_s = 1e-3;
    record.evaluations = 5000;
  }
  EXPECT_EQ(compare_runs(soon, soon).why_no_seconds, "no fit took 0.02 s");
  EXPECT_EQ(compare_runs(soon, soon).cost_currency, CostCurrency::evaluations);
  EXPECT_EQ(compare_runs(soon, soon).cost.size(), 3U);
}

// A run's folder with nothing but the grid that took effect.
RunFolder asked_for(const testing::TemporaryFolder& folder, const std::string& name,
                    const std::string& grid) {
  RunFolder run = noisy_run("x", 5);
  run.path = folder / name;
  testing::write_text(run.path / "grid.toml", grid);
  return run;
}

TEST(Comparison, OfRunsThatWereAskedDifferentThingsIsUndecidedUnlessAllowed) {
  const testing::TemporaryFolder folder;
  const std::string grid =
      "[budget]\nevaluations = 500000000\nseconds = 120.0\n\n[grid]\nname = 'nightly'\n"
      "problems = [\n    'A/j2/load',\n    'B/j2/load'\n]\n\n[grid.seeds]\ncount = 10\n\n"
      "[[method]]\nalgorithm = 'pysr'\nname = 'many'\n\n[method.parameters]\npopulations = 8\n";
  const RunFolder base = asked_for(folder, "base", grid);
  const RunFolder renamed =
      asked_for(folder, "renamed", std::string(grid).replace(grid.find("nightly"), 7, "another"));
  EXPECT_EQ(compare_runs(base, renamed).outcome(), ComparisonOutcome::fine);

  std::string other = grid;
  other.replace(other.find("500000000"), 9, "2000000");
  other.replace(other.find("populations = 8"), 15, "populations = 9");
  other.replace(other.find("'A/j2/load'"), 11, "'A/j4/load'");
  const RunFolder now = asked_for(folder, "now", other);
  const Comparison refused = compare_runs(base, now);
  EXPECT_EQ(refused.outcome(), ComparisonOutcome::undecided);
  EXPECT_THAT(refused.conditions,
              ::testing::UnorderedElementsAre(HasSubstr("grid.problems"),
                                              "budget.evaluations: 500000000 -> 2000000",
                                              "method many.parameters.populations: 8 -> 9"));
  const std::string page = comparison_markdown(refused);
  EXPECT_LT(page.find("500000000 -> 2000000"), page.find("UNDECIDED")) << "not said first";
  ComparisonOptions allowing;
  allowing.allow_conditions = true;
  EXPECT_EQ(compare_runs(base, now, allowing).outcome(), ComparisonOutcome::fine);

  RunFolder other_data = asked_for(folder, "data", grid);
  other_data.provenance.emplace_back("data_hash", "1234");
  EXPECT_THAT(compare_runs(base, other_data).conditions, ::testing::ElementsAre("the data differ"));
}

// The case that passed: ten seeds, one method 2.6 times as bad on one problem, p = 0.02 after
// adjustment.
TEST(Comparison, ALargeLossThatIsNotSignificantIsUndecided) {
  const RunFolder base = noisy_run("base", 5);
  RunFolder now = noisy_run("new", 5);
  for (Record& record : now.records) {
    if (record.method == "b" && record.problem == "p0") record.mae_test *= 2.6;
  }
  const Comparison comparison = compare_runs(base, now);
  EXPECT_FALSE(comparison.has_regression());
  EXPECT_EQ(comparison.outcome(), ComparisonOutcome::undecided);
  EXPECT_THAT(comparison_markdown(comparison), HasSubstr("b (paper) on p0: 16"));
  // Its interval is all above 1 and its p is not small: what each of them asks is said.
  EXPECT_THAT(comparison_markdown(comparison), HasSubstr("two questions"));
  EXPECT_THAT(comparison_head(comparison), HasSubstr("two questions"));
  ComparisonOptions tolerant;
  tolerant.tolerance = 4;
  EXPECT_EQ(compare_runs(base, now, tolerant).outcome(), ComparisonOutcome::fine);
}

TEST(Comparison, SaysWhichLossItWouldHaveSeen) {
  const Comparison sharp = compare_runs(noisy_run("base", 20), noisy_run("new", 20));
  std::size_t asked = 0;
  for (const ComparisonRow& row : sharp.quality) {
    if (row.problem.empty()) continue;
    ++asked;
    EXPECT_GT(row.detectable, 0.01);
    EXPECT_LT(row.detectable, 0.10) << row.method << row.problem;
  }
  EXPECT_EQ(asked, 12U);
  EXPECT_THAT(sharp.visibility(), HasSubstr("of 12 comparisons of a method on a problem"));
  // Five seeds can never reach the level of one of 18 tests.
  const Comparison blind = compare_runs(noisy_run("base", 5), noisy_run("new", 5));
  EXPECT_THAT(blind.visibility(), HasSubstr("in 0 of 12"));
  EXPECT_THAT(blind.visibility(), HasSubstr("none at all (too few pairs)"));
}

// What is said to be seen is seen: the loss it names, planted in fresh noise.
TEST(Comparison, FindsTheLossItSaysItWouldFind) {
  int found = 0;
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::string key = std::to_string(trial);
    const RunFolder base = noisy_run("base" + key, 20);
    const Comparison before = compare_runs(base, noisy_run("new" + key, 20));
    double loss = 0;
    for (const ComparisonRow& row : before.quality) {
      if (row.method == "b" && row.problem == "p1") loss = row.detectable;
    }
    RunFolder now = noisy_run("later" + key, 20);
    for (Record& record : now.records) {
      if (record.method == "b" && record.problem == "p1") record.mae_test *= 1 + loss;
    }
    for (const ComparisonRow& row : compare_runs(base, now).quality) {
      if (row.method == "b" && row.problem == "p1") {
        found += row.verdict == ComparisonVerdict::worse ? 1 : 0;
      }
    }
  }
  EXPECT_GE(found, 11) << "promised: 16 of 20";
}

TEST(Comparison, MissingCellsAndSingularFormulasCount) {
  const RunFolder base = noisy_run("x", 20);
  RunFolder now = base;
  now.records.pop_back();
  EXPECT_EQ(compare_runs(base, now).outcome(), ComparisonOutcome::undecided);
  now = base;
  for (std::size_t i = 0; i < 6; ++i) now.records[i].singularity = Singularity::refuted;
  EXPECT_EQ(compare_runs(base, now).outcome(), ComparisonOutcome::undecided);
  for (std::size_t i = 0; i < 12; ++i) now.records[i].singularity = Singularity::refuted;
  EXPECT_EQ(compare_runs(base, now).outcome(), ComparisonOutcome::regression);
}

TEST(Comparison, ProofsThatAreLostLeaveItUndecided) {
  RunFolder base = noisy_run("x", 20);
  for (Record& record : base.records) record.singularity = Singularity::proved_free;
  RunFolder now = base;
  now.records[0].singularity = Singularity::undecided;
  EXPECT_EQ(compare_runs(base, now).outcome(), ComparisonOutcome::fine) << "one is chance";
  for (std::size_t i = 0; i < 12; ++i) now.records[i].singularity = Singularity::undecided;
  const Comparison lost = compare_runs(base, now);
  EXPECT_EQ(lost.outcome(), ComparisonOutcome::undecided);
  EXPECT_THAT(comparison_markdown(lost), HasSubstr("12 formulas are newly without a proof"));
  EXPECT_EQ(comparison_json(lost)["newly_unproved"].size(), 12U);
  EXPECT_EQ(compare_runs(now, base).outcome(), ComparisonOutcome::fine)
      << "more proofs are no loss";
}

TEST(Comparison, ACrashIsARegressionAndASingleTimeoutIsNot) {
  const RunFolder base = noisy_run("x", 20);
  RunFolder now = base;
  now.records[3].status = CellStatus::failed;
  now.records[3].reason = {FailureKind::timeout, {}};
  EXPECT_FALSE(compare_runs(base, now).has_regression());
  now.records[3].reason = {FailureKind::crashed, "SIGSEGV"};
  EXPECT_TRUE(compare_runs(base, now).has_regression());
  for (std::size_t i = 0; i < 12; ++i) {
    now.records[i].status = CellStatus::failed;
    now.records[i].reason = {FailureKind::timeout, {}};
  }
  EXPECT_TRUE(compare_runs(base, now).has_regression());
}

TEST(Comparison, CountsCellsThatOnlyOneRunHas) {
  const RunFolder base = noisy_run("x", 3);
  RunFolder now = base;
  now.records.pop_back();
  now.records[0].cell += "0";
  now.records[1].singularity = Singularity::refuted;
  const Comparison comparison = compare_runs(base, now);
  EXPECT_EQ(comparison.only_base, 2U);
  EXPECT_EQ(comparison.only_new, 1U);
  EXPECT_EQ(comparison.newly_singular, (std::vector<std::string>{base.records[1].cell}));
  EXPECT_THAT(comparison_markdown(comparison), HasSubstr("Newly singular (1)"));
  EXPECT_EQ(comparison_json(comparison)["only_base"], 2);
}

}  // namespace
}  // namespace tribench
