// SPDX-License-Identifier: MIT
#include "reports/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/run_reports.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(RunFolder, ReadsAFinishedRunAndNamesTheMissingCell) {
  const auto folder = fresh_folder("finished");
  write_sample_run(folder, 2);
  const RunFolder run = read_run_folder(folder);
  EXPECT_EQ(run.name, "sample");
  EXPECT_EQ(run.records.size(), 20U);
  EXPECT_EQ(run.planned, 21U);
  ASSERT_EQ(run.missing.size(), 1U);
  EXPECT_EQ(run.missing[0].seed, 99U);
  EXPECT_EQ(run.provenance_of("code.commit"), "abc1234");
  EXPECT_TRUE(run.complaints.empty());
}

TEST(RunFolder, ReadsADamagedRunAndSaysWhatIsWrong) {
  const auto folder = fresh_folder("damaged");
  write_sample_run(folder, 2);
  std::string text = text_of(folder / "results.csv");
  write_file(folder / "results.csv", text.substr(0, text.size() - 200));
  write_file(folder / "provenance.json", "{\"version\": ");
  const RunFolder run = read_run_folder(folder);
  EXPECT_EQ(run.records.size(), 19U);
  EXPECT_EQ(run.missing.size(), 2U);
  EXPECT_THAT(run.complaints, Contains(HasSubstr("torn off")));
  EXPECT_THAT(run.complaints, Contains(HasSubstr("provenance.json is damaged")));
}

TEST(RunFolder, ReadsARunThatHasNotEndedAnyCell) {
  const auto folder = fresh_folder("fresh");
  write_file(folder / "grid.toml", "[grid]\nname = 'nightly'\n");
  const RunFolder run = read_run_folder(folder);
  EXPECT_EQ(run.name, "nightly");
  EXPECT_TRUE(run.records.empty());
  EXPECT_THAT(run.complaints, Contains(HasSubstr("results.csv is missing")));
  EXPECT_THAT(write_run_reports(folder), HasSubstr("0 cells"));
}

TEST(RunFolder, CountsACellThatStandsTwiceOnce) {
  const auto folder = fresh_folder("twice");
  std::vector<Record> records = sample_records(1);
  records.push_back(records.front());
  write_file(folder / "results.csv", results_csv(records));
  const RunFolder run = read_run_folder(folder);
  EXPECT_EQ(run.records.size(), records.size() - 1);
  EXPECT_THAT(run.complaints, Contains(HasSubstr("1 cells stand there more than once")));
}

TEST(RunFolder, RefusesAFolderThatIsNoRun) {
  EXPECT_THROW(read_run_folder(fresh_folder("empty")), Error);
}

}  // namespace
}  // namespace tribench
