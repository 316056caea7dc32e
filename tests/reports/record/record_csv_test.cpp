// SPDX-License-Identifier: MIT
#include "reports/record/record_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

TEST(ResultsCsv, IsByteForByteWhatWasAgreed) {
  expect_golden(results_csv(sample_records(2)), "reports/results.csv");
}

TEST(ResultsCsv, DoesNotDependOnTheOrderInWhichCellsEnded) {
  std::vector<Record> records = sample_records(3);
  const std::string forward = results_csv(records);
  std::reverse(records.begin(), records.end());
  EXPECT_EQ(results_csv(records), forward);
}

TEST(ResultsCsv, ReadsBackToTheSameText) {
  const auto folder = fresh_folder("round_trip");
  const std::string text = results_csv(sample_records(2));
  write_file(folder / "results.csv", text);
  std::vector<Record> back;
  read_results(folder / "results.csv", [&](Record&& record) { back.push_back(record); });
  EXPECT_EQ(results_csv(back), text);
}

TEST(ResultsCsv, DropsARowWithAWordWhereANumberBelongsAndSaysSo) {
  const auto folder = fresh_folder("bad_number");
  write_file(folder / "results.csv", "cell,seed,mae_test\na,1,0.5\nb,2,many\nc,3,\n");
  std::vector<Record> back;
  const CsvReading reading =
      read_results(folder / "results.csv", [&](Record&& record) { back.push_back(record); });
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[1].cell, "c");
  EXPECT_TRUE(std::isnan(back[1].mae_test));
  ASSERT_EQ(reading.complaints.size(), 1U);
  EXPECT_EQ(reading.complaints[0], "row 2: many is not a value of mae_test; dropped");
}

TEST(ResultsCsv, CountsTheRowsThatItHandsOn) {
  const auto folder = fresh_folder("counted");
  write_file(folder / "results.csv", "cell,seed,singularity\na,1x,\nb,2,perhaps\nc,3,refuted\n");
  std::vector<Record> back;
  const CsvReading reading =
      read_results(folder / "results.csv", [&](Record&& record) { back.push_back(record); });
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].singularity, Singularity::refuted);
  EXPECT_EQ(reading.rows, 1U);
  EXPECT_EQ(reading.complaints,
            (std::vector<std::string>{"row 1: 1x is not a value of seed; dropped",
                                      "row 2: perhaps is not a value of singularity; dropped"}));
}

TEST(ResultsCsv, RefusesAFileThatIsNone) {
  const auto folder = fresh_folder("no_cell");
  write_file(folder / "results.csv", "a,b\n1,2\n");
  EXPECT_THROW(read_results(folder / "results.csv", [](Record&&) {}), Error);
  EXPECT_THROW(read_results(folder / "absent.csv", [](Record&&) {}), Error);
}

TEST(FrontTraceAndCurves, ReadBackAsWritten) {
  const auto folder = fresh_folder("others");
  write_file(folder / "front.csv",
             front_csv({{"a|b", 3, 4, 0.5, 0.6, Singularity::refuted, true, "x, \"y\""}}));
  write_file(folder / "trace.csv", trace_csv({{"a|b", 12, 0.25, 1e-9}}));
  write_file(
      folder / "curves.csv",
      curves_csv({{"a|b", "p", "m", "paper", "friction", "true law", "v", "tau", 1, kMissing}}));
  read_front(folder / "front.csv", [](FrontRecord&& front) {
    EXPECT_TRUE(front.chosen);
    EXPECT_EQ(front.formula, "x, \"y\"");
  });
  read_trace(folder / "trace.csv", [](TraceRecord&& trace) {
    EXPECT_EQ(trace.evaluations, 12U);
    EXPECT_EQ(trace.train_error, 1e-9);
  });
  read_curves(folder / "curves.csv", [](CurveRecord&& curve) {
    EXPECT_EQ(curve.picture, "friction");
    EXPECT_TRUE(std::isnan(curve.y));
  });
}

}  // namespace
}  // namespace tribench
