// SPDX-License-Identifier: MIT
#include "reports/leaderboard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/output_file.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/run_reports.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

TEST(Leaderboard, IsByteForByteWhatWasAgreed) {
  const auto folder = fresh_folder("leaderboard");
  write_sample_run(folder, 2);
  const std::string head = write_run_reports(folder);
  const std::string text = text_of(folder / "leaderboard.md");
  EXPECT_TRUE(text.starts_with(head));
  expect_golden(text, "reports/leaderboard.md");
}

TEST(Leaderboard, ShowsFailuresMissingCellsAndWitnesses) {
  const auto folder = fresh_folder("leaderboard_failures");
  write_sample_run(folder, 2);
  write_run_reports(folder);
  const std::string text = text_of(folder / "leaderboard.md");
  EXPECT_THAT(text, HasSubstr("crashed (SIGSEGV)"));
  EXPECT_THAT(text, HasSubstr("missing: `A/j4/no_load|pysr|paper|99`"));
  EXPECT_THAT(text, HasSubstr(R"(at `{"qd": 0.25}`)"));
  EXPECT_THAT(text, HasSubstr("places and tests are of what is there"));
}

TEST(Leaderboard, SaysOnItsFirstScreenWhatChangedSinceABaseRun) {
  const auto base = fresh_folder("leaderboard_base");
  write_sample_run(base, 2);
  const auto now = fresh_folder("leaderboard_now");
  write_sample_run(now, 2);
  std::vector<Record> records = sample_records(2);
  for (Record& record : records) {
    if (record.cell != "A/j2/no_load|pysr|paper|1") continue;
    record.status = CellStatus::failed;
    record.reason = {FailureKind::timeout, {}};
    record.formula.clear();
    record.mae_test = kMissing;
  }
  write_file(now / "results.csv", results_csv(records));
  const std::string head = write_run_reports(now, base / "");  // as a shell completes it
  EXPECT_THAT(head, HasSubstr("## What changed"));
  EXPECT_THAT(head, HasSubstr("Since sample (tribench_reports_leaderboard_base)"));
  EXPECT_THAT(head, HasSubstr("- `A/j2/no_load|pysr|paper|1`"));
  EXPECT_TRUE(text_of(now / "leaderboard.md").starts_with(head));
  EXPECT_THAT(text_of(now / "report.html"), HasSubstr(R"("newly_failed":["A/j2/no_load|pysr)"));
}

}  // namespace
}  // namespace tribench
