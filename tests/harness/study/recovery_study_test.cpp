// SPDX-License-Identifier: MIT
#include "harness/study/recovery_study.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "reports/record/record_csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

Record nguyen_record(int number, std::uint64_t seed, double r2_test) {
  Record record;
  record.problem = "nguyen/" + std::to_string(number);
  record.dataset = "nguyen";
  record.method = "udsr";
  record.operators = "koza";
  record.seed = seed;
  record.cell = record.problem + "|udsr|koza|" + std::to_string(seed);
  record.status = CellStatus::ok;
  record.r2_test = r2_test;
  record.fit_cpu_s = static_cast<double>(seed);
  return record;
}

fs::path folder_with(const std::string& name, std::vector<Record> records) {
  const fs::path run = testing::scratch_folder() / name;
  fs::create_directories(run);
  write_file(run / "results.csv", results_csv(std::move(records)));
  return run;
}

TEST(RecoveryStudy, CountsWhatIsExactAndFailuresAsMissesInTheOrderOfTheNumbers) {
  Record failed = nguyen_record(2, 3, 1.0);
  failed.status = CellStatus::failed;
  const std::vector<RecoveryFigure> figures = run_recovery_study(
      folder_with("tribench_recovery", {nguyen_record(10, 1, 1.0), nguyen_record(2, 1, 1 - 1e-9),
                                        nguyen_record(2, 2, 1 - 1e-14), failed}));
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[0].problem, "nguyen/2");
  EXPECT_EQ(figures[0].recovered, 1U);
  EXPECT_EQ(figures[0].runs, 3U);
  EXPECT_DOUBLE_EQ(figures[0].median_cpu_s, 2);
  EXPECT_EQ(figures[1].problem, "nguyen/10");
  EXPECT_EQ(figures[1].recovered, 1U);
}

TEST(RecoveryStudy, RefusesARunWithoutTheNguyenSet) {
  Record other = nguyen_record(1, 1, 1);
  other.dataset = "A";
  EXPECT_THROW(run_recovery_study(folder_with("tribench_no_recovery", {other})), Error);
}

}  // namespace
}  // namespace tribench
