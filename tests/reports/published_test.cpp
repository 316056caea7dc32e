// SPDX-License-Identifier: MIT
#include "reports/published.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "reports/csv.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/run_reports.hpp"
#include "tests/reports/sample_run.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

Record record_of(const std::string& problem, const std::string& method, std::uint64_t seed,
                 double mae) {
  Record r;
  r.cell = problem + "|" + method + "|paper|" + std::to_string(seed);
  r.problem = problem;
  r.dataset = problem.substr(0, 1);
  r.method = method;
  r.operators = "paper";
  r.seed = seed;
  r.status = std::isnan(mae) ? CellStatus::failed : CellStatus::ok;
  r.reason.kind = std::isnan(mae) ? FailureKind::timeout : FailureKind::none;
  r.mae_test = mae;
  r.mae_ceiling = std::isnan(mae) ? kMissing : 1.0;
  r.mae_law = r.mae_ceiling;
  r.mae_refitted = problem.starts_with("B/") ? 1.25 * r.mae_ceiling : kMissing;
  r.formula = std::isnan(mae) ? "" : "qd";
  r.complexity = 15;
  r.complexity_adaptation = problem.starts_with("B/") ? 4 : 0;
  r.singularity = Singularity::proved_free;
  return r;
}

std::string shipped_figures() {
  return text_of(testing::source_dir() / "grids/paper_reference.csv");
}

// leaderboard.md of a run with these records and the paper's figures beside it.
std::string board_of(const std::string& name, const std::vector<Record>& records) {
  const fs::path folder = fresh_folder("published_" + name);
  write_file(folder / "results.csv", results_csv(records));
  write_file(folder / kPublishedFile, shipped_figures());
  write_run_reports(folder);
  return text_of(folder / "leaderboard.md");
}

TEST(Published, StandBesideOurMedianItsSpreadTheCeilingAndTheTrueLaw) {
  const std::string text =
      board_of("beside",
               {record_of("A/j2/load", "pysr", 1, 1.1), record_of("A/j2/load", "pysr", 2, 1.02),
                record_of("A/j2/load", "pysr", 3, 1.5), record_of("A/j2/load", "udsr", 1, kMissing),
                record_of("B/j2/load", "parfam", 1, 1.02)});
  EXPECT_THAT(text, HasSubstr("### Table 2: A/j2/load"));
  EXPECT_THAT(text, Not(HasSubstr("### Table 1")));  // the run has none of it
  EXPECT_THAT(text, HasSubstr("| PySR                   |   1.294 |             13 | pysr"));
  EXPECT_THAT(text,
              HasSubstr("| 1.02 .. 1.50 |          1.00 |            - |             +10.0 "));
  EXPECT_THAT(text, HasSubstr("not in this run"));
  EXPECT_THAT(text, HasSubstr("Noise ceiling 1.00; the true law's error 1.00."));
  // The complexity of the adaptation alone, as the paper counts.
  EXPECT_THAT(text, HasSubstr("|         1.25 |              +2.0 % |                  -18.4 % |   "
                              "           4 |"));
  EXPECT_THAT(text, HasSubstr("1.00, 1.25 with its constants fitted to the training rows."));
}

TEST(Published, RemarksSayWhatIsReachedWhatIsNotAndWhy) {
  const std::string text =
      board_of("remarks", {record_of("A/j2/no_load", "pysr", 1, 1.2),
                           record_of("A/j2/no_load", "parfam", 1, 1.01),
                           record_of("A/j2/no_load", "asymmetric_as_printed", 1, 1.11),
                           record_of("A/j2/no_load", "asymmetric", 1, 0.9),
                           record_of("A/j2/no_load", "branch_polynomial", 1, 1.04),
                           record_of("A/j4/no_load", "pysr", 1, 1.2),
                           record_of("A/j4/no_load", "symmetric_as_printed", 1, 3)});
  EXPECT_THAT(text, HasSubstr("Best symbolic regression: parfam (paper), 1.01; seed by seed +1.0 % "
                              "against the noise ceiling, within 3 %."));
  EXPECT_THAT(text, HasSubstr("pysr (1.20) is not better than the baseline asymmetric_as_printed"));
  EXPECT_THAT(text, HasSubstr("As good as symbolic regression here (within 5 %): "
                              "asymmetric (paper, 0.900), branch_polynomial (paper, 1.04)."));
  EXPECT_THAT(text, HasSubstr("+20.0 % against the noise ceiling, not within 3 %."));
  EXPECT_THAT(text, HasSubstr("Each of pysr is better than every baseline"));
  EXPECT_THAT(text, HasSubstr("repeats the symmetric fit"));  // the printed branch v <= 0
}

TEST(Published, NearnessToTheCeilingIsJudgedSeedBySeedWithItsUncertainty) {
  // Seeds differ by a factor of ten in their noise, which the ratio by seed does not feel.
  std::vector<Record> records;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const double ceiling = seed % 2 == 0 ? 0.1 : 1.0;
    for (const char* problem : {"A/j2/no_load", "A/j4/no_load"}) {
      const bool sure = problem[3] == '2';
      const double excess = sure ? 0.10 : (seed <= 4 ? 0.01 : 0.06);
      Record r = record_of(problem, "pysr", seed, (1 + excess) * ceiling);
      r.mae_ceiling = ceiling;
      records.push_back(r);
    }
  }
  const std::string text = board_of("nearness", records);
  EXPECT_THAT(text, HasSubstr("+10.0 % (+10.0 .. +10.0) against the noise ceiling, not within 3"));
  EXPECT_THAT(text, HasSubstr("+6.0 % (+1.0 .. +6.0) against the noise ceiling, cannot be told "
                              "from 3 %."));
}

TEST(Published, ADamagedFileIsRefusedBeforeARunAndComplainedOfAfterIt) {
  EXPECT_NO_THROW(check_published(shipped_figures(), "grids/paper_reference.csv"));
  EXPECT_THROW(check_published("table,problem\nTable 1,A/j2/load\n", "mine.csv"), Error);
  std::string wrong = shipped_figures();
  wrong.replace(wrong.find("0.737"), 5, "none!");
  EXPECT_THROW(check_published(wrong, "mine.csv"), Error);
  const fs::path folder = fresh_folder("published_damaged");
  write_file(folder / kPublishedFile, wrong);
  std::vector<std::string> complaints;
  EXPECT_FALSE(read_published(folder / kPublishedFile, complaints).empty());
  EXPECT_THAT(complaints, ::testing::ElementsAre(HasSubstr("'none!'")));
}

// The figures that ship against the table they were taken from.
TEST(Published, TheShippedFiguresAreThePrintedOnes) {
  const auto reference = testing::shared_reference();
  if (!reference) GTEST_SKIP() << "no reference material beside the checkout";
  using Figure = std::tuple<std::string, std::string, double, double>;  // table, method
  const auto figures_in = [](const fs::path& file, const char* method, const char* mae) {
    std::ifstream in(file);
    std::vector<std::string> names;
    std::multiset<Figure> figures;
    read_csv(
        in, [&](const auto& fields) { names.assign(fields.begin(), fields.end()); },
        [&](const auto& fields) {
          std::map<std::string, std::string> row;
          for (std::size_t i = 0; i < fields.size(); ++i) row[names[i]] = fields[i];
          if (row[mae].empty()) return;
          const std::string table = row["table"];
          figures.insert({table.substr(table.size() - 1), row[method], std::stod(row[mae]),
                          std::stod(row["complexity"])});
        });
    return figures;
  };
  const auto printed = figures_in(*reference / "paper_tables.csv", "method", "mae_nm");
  EXPECT_EQ(printed.size(), 40U);
  EXPECT_EQ(
      figures_in(testing::source_dir() / "grids/paper_reference.csv", "published_method", "mae"),
      printed);
}

}  // namespace
}  // namespace tribench
