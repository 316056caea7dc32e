// SPDX-License-Identifier: MIT
#include "harness/study/external_torque_study.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "problems/kuka/joint.hpp"
#include "reports/record/record_csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

Record loaded_record(const std::string& method, std::uint64_t seed, const std::string& formula) {
  Record record;
  record.cell = "B/j2/load|" + method + "|paper|" + std::to_string(seed);
  record.problem = "B/j2/load";
  record.dataset = "B";
  record.joint = 2;
  record.load = true;
  record.method = method;
  record.operators = "paper";
  record.seed = seed;
  record.status = CellStatus::ok;
  record.formula = formula;
  return record;
}

TEST(ExternalTorqueStudy, RanksTheTrueLawBeforeAConstantBeforeNothing) {
  const fs::path run = testing::scratch_folder() / "tribench_external_torque";
  fs::create_directories(run);
  std::vector<Record> records;
  for (const std::uint64_t seed : {1U, 2U}) {
    records.push_back(loaded_record("law", seed, kuka::make_joint(2, seed).law.formula(true)));
    records.push_back(loaded_record("coulomb", seed, "10*sgn_qd"));
  }
  Record failed = loaded_record("broken", 1, "");
  failed.status = CellStatus::failed;
  records.push_back(failed);
  write_file(run / "results.csv", results_csv(records));
  const std::vector<ExternalTorqueFigure> figures = run_external_torque_study(run);
  ASSERT_EQ(figures.size(), 4U);  // two methods and two yardsticks
  EXPECT_EQ(figures[0].model, "(true law and shift)");
  EXPECT_EQ(figures[1].model, "law");
  EXPECT_EQ(figures[2].model, "coulomb");
  EXPECT_EQ(figures[3].model, "(no friction model)");
  EXPECT_EQ(figures[1].seeds, 2U);
  EXPECT_LE(figures[1].low_nm, figures[1].mae_nm);
  EXPECT_LE(figures[1].mae_nm, figures[1].high_nm);
  // What the payload's own friction and the noise leave, and not much more.
  EXPECT_LT(figures[0].mae_nm, 1.2);
  fs::remove_all(run);
}

TEST(ExternalTorqueStudy, ARunWithoutLoadedBIsAnError) {
  const fs::path run = testing::scratch_folder() / "tribench_no_external_torque";
  fs::create_directories(run);
  write_file(run / "results.csv", results_csv({}));
  EXPECT_THROW(run_external_torque_study(run), Error);
  fs::remove_all(run);
}

}  // namespace
}  // namespace tribench
