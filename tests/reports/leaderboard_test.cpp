#include "reports/leaderboard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(text, HasSubstr("within 1 %"));
}

}  // namespace
}  // namespace tribench
