// SPDX-License-Identifier: MIT
#include "harness/study/paper_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "foundation/error.hpp"
#include "harness/study/paper_figures.hpp"
#include "problems/catalogue.hpp"
#include "reports/record_csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Record record(const std::string& problem, const std::string& method, std::uint64_t seed,
              double mae) {
  Record made;
  made.cell = problem + "|" + method + "|paper|" + std::to_string(seed);
  made.problem = problem;
  made.dataset = problem.substr(0, 1);
  made.joint = 2;
  made.method = method;
  made.operators = "paper";
  made.seed = seed;
  made.status = std::isnan(mae) ? "failed" : "ok";
  made.mae_test = mae;
  made.formula = std::isnan(mae) ? "" : "qd";
  made.complexity = 15;
  made.complexity_adaptation = problem.starts_with("B/") ? 4 : 0;
  made.singularity = "proved_free";
  return made;
}

std::vector<PaperProblem> study_of(const std::vector<Record>& records) {
  const fs::path run =
      fs::path(::testing::TempDir()) /
      ("tribench_paper_" +
       std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
  fs::create_directories(run);
  write_file(run / "results.csv", results_csv(records));
  std::vector<PaperProblem> problems = run_paper_study(run);
  fs::remove_all(run);
  return problems;
}

TEST(PaperStudy, SetsMedianSpreadAndThePapersFigureSideBySide) {
  const std::vector<PaperProblem> problems =
      study_of({record("A/j2/load", "pysr", 1, 1.1), record("A/j2/load", "pysr", 2, 1.0),
                record("A/j2/load", "pysr", 3, 1.5), record("A/j2/load", "udsr", 1, kMissing),
                record("A/j2/load", "asymmetric_as_printed", 1, 3.8),
                record("A/j2/load", "symmetric_as_printed", 1, 3.9),
                record("B/j2/load", "parfam", 1, 0.7), record("A/j2/no_load", "constant", 1, 9)});
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_EQ(problems[0].name, "A/j2/no_load");
  EXPECT_EQ(problems[1].name, "A/j2/load");
  EXPECT_EQ(problems[2].table, 3);
  const PaperProblem& load = problems[1];
  ASSERT_EQ(load.rows.size(), 4U);
  EXPECT_EQ(load.rows[0].method, "pysr");
  EXPECT_EQ(load.rows[0].mae_nm, 1.1);
  EXPECT_EQ(load.rows[0].low_nm, 1.0);
  EXPECT_EQ(load.rows[0].high_nm, 1.5);
  EXPECT_EQ(load.rows[0].paper_mae_nm, 1.294);
  EXPECT_EQ(load.rows[1].paper_mae_nm, 4.073);
  EXPECT_EQ(load.rows[3].failed, 1U);
  EXPECT_EQ(problems[2].rows[0].complexity, 4);
  const std::string text = paper_study_markdown(problems);
  EXPECT_THAT(text, HasSubstr("| pysr | paper | 1.100 | 1.000 to 1.500 | 15 | 1.294 | 13 |"));
  EXPECT_THAT(text, HasSubstr("no stationary generator"));
}

TEST(PaperStudy, TheCeilingIsWhatTheTruthLeaves) {
  const std::vector<PaperProblem> problems = study_of({record("A/j2/load", "pysr", 4, 1.1)});
  const Table test = Catalogue().find("A/j2/load").make(4).test;
  double sum = 0;
  for (std::size_t r = 0; r < test.rows(); ++r) sum += std::abs(test.target[r] - test.truth[r]);
  EXPECT_NEAR(problems[0].ceiling_nm, sum / static_cast<double>(test.rows()), 1e-12);
}

TEST(PaperStudy, SaysWhenAPlainModelIsAsGoodAndWhenSymbolicRegressionIsNotBetter) {
  const std::vector<PaperProblem> problems =
      study_of({record("A/j2/no_load", "pysr", 1, 0.20),
                record("A/j2/no_load", "asymmetric_as_printed", 1, 0.11),
                record("A/j2/no_load", "branch_polynomial", 1, 0.04)});
  std::string all;
  for (const std::string& remark : problems[0].remarks) all += remark + "\n";
  EXPECT_THAT(all, HasSubstr("pysr (0.200) is not better than asymmetric_as_printed (0.110)"));
  EXPECT_THAT(all, HasSubstr("branch_polynomial (0.040) is as good as symbolic regression"));
  EXPECT_THAT(all, HasSubstr("not within 3 %"));
}

TEST(PaperStudy, ARunWithoutTheDatasetsIsAnError) { EXPECT_THROW(study_of({}), Error); }

// The embedded figures against the reference table.
TEST(PaperStudy, TheFiguresAreThePrintedOnes) {
  const auto reference = testing::shared_reference();
  if (!reference) GTEST_SKIP() << "no reference material beside the checkout";
  std::ifstream in(*reference / "paper_tables.csv");
  std::string line;
  std::getline(in, line);
  std::multiset<std::tuple<int, double, int>> printed;
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    printed.insert({std::stoi(cells[0]), std::stod(cells[6]), std::stoi(cells[7])});
  }
  std::multiset<std::tuple<int, double, int>> embedded;
  for (const PaperFigure& figure : kPaperFigures) {
    embedded.insert({figure.table, figure.mae_nm, figure.complexity});
  }
  EXPECT_EQ(embedded, printed);
}

}  // namespace
}  // namespace tribench
