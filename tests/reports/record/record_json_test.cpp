// SPDX-License-Identifier: MIT
#include "reports/record/record_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "foundation/error.hpp"
#include "foundation/text.hpp"
#include "reports/record/record_columns.hpp"
#include "tests/reports/sample_run.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;

TEST(RecordColumns, AreNamedOnce) {
  std::set<std::string> names;
  for (const auto& column : result_columns()) EXPECT_TRUE(names.insert(column.name).second);
  EXPECT_STREQ(result_columns().front().name, "cell");
}

TEST(RecordColumns, OfTimeAndMachineAreForgotten) {
  Record record;
  record.fit_cpu_s = record.fit_wall_s = record.fit_instructions = 1;
  record.peak_memory_mib = record.eval_ns_per_row = 1;
  record.mae_test = 2;
  forget_costs(record);
  EXPECT_TRUE(std::isnan(record.fit_cpu_s + record.fit_wall_s));
  EXPECT_TRUE(std::isnan(record.fit_instructions));
  EXPECT_TRUE(std::isnan(record.peak_memory_mib));
  EXPECT_TRUE(std::isnan(record.eval_ns_per_row));
  EXPECT_EQ(record.mae_test, 2);
}

// A line that an earlier program wrote is written again byte for byte, but for the figure that it
// did not know yet.
TEST(RecordJson, IsByteForByteWhatJournalsHold) {
  const std::string journal = read_file(testing::source_dir() / "tests/fuzz/corpus/journal/run");
  const std::size_t start = journal.find('\n') + 1;
  const std::string line = journal.substr(start, journal.find('\n', start) - start);
  const nlohmann::json before = nlohmann::json::parse(line).at("record");
  nlohmann::json after = record_json(parse_record(before));
  EXPECT_TRUE(after.at("fit_instructions").is_null());
  after.erase("fit_instructions");
  EXPECT_EQ(after.dump(), before.dump());
}

TEST(RecordJson, RefusesANumberThatItsTypeDoesNotHold) {
  nlohmann::json object = record_json(sample_records(1).front());
  for (const char* number :
       {"1.8e20", "4294967296", "-2147483649", "2.5", "18446744073709551615"}) {
    object["joint"] = nlohmann::json::parse(number);
    EXPECT_THROW(parse_record(object), Error) << number;
  }
  object["joint"] = 4;
  object["evaluations"] = -1;
  EXPECT_THROW(parse_record(object), Error);
}

TEST(RecordJson, ReadsBackEveryRowOfASampleRun) {
  for (const Record& record : sample_records(2)) {
    const std::string text = record_json(record).dump();
    EXPECT_EQ(record_json(parse_record(nlohmann::json::parse(text))).dump(), text);
  }
}

TEST(RecordJson, HasTheErrorOfMotionOnlyWhereItIsKnown) {
  Record record = sample_records(1).front();
  record.motion_error = kMissing;
  EXPECT_FALSE(record_json(record).contains("motion_error"));
  record.motion_error = 0.25;
  EXPECT_EQ(parse_record(record_json(record)).motion_error, 0.25);
}

TEST(RecordJson, RefusesAWordThatIsNoneOfTheColumns) {
  nlohmann::json object = record_json(sample_records(1).front());
  object["singularity"] = "perhaps";
  try {
    parse_record(object);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"perhaps\" is not a value of singularity"));
  }
}

TEST(RecordRow, HasTheColumnsAskedForInTheirOrderAndNoOther) {
  Record record;
  record.cell = "a cell";
  record.method = "line";
  EXPECT_EQ(record_row(record, {"method", "cell"}).dump(), "[\"line\",\"a cell\"]");
  // A cell that failed has no formula, and so no complexity.
  EXPECT_EQ(record_row(record, {"complexity", "seed"}).dump(), "[null,0]");
  record.formula = "3";
  record.complexity = 1;
  EXPECT_EQ(record_row(record, {"complexity"}).dump(), "[1]");
  EXPECT_THROW(record_row(record, {"method", "no_column"}), Error);
}

TEST(FailureReason, IsReadBackWhateverItSays) {
  for (const std::string text :
       {"", "timeout", "cpu_limit", "out_of_memory", "quarantined", "crashed (SIGSEGV)",
        "error (no formula: (a) and (b))", "unsupported ()", "error (", "errors (x)", "error (x) y",
        "other", "anything else"}) {
    EXPECT_EQ(reason_text(read_reason(text)), text);
  }
  EXPECT_EQ(read_reason("crashed (SIGSEGV)"), (FailureReason{FailureKind::crashed, "SIGSEGV"}));
  EXPECT_EQ(read_reason("errors (x)").kind, FailureKind::other);
  EXPECT_EQ(read_reason("").kind, FailureKind::none);
}

TEST(FailureReason, IsALimitWhereTheMachineHasASay) {
  for (const FailureKind kind :
       {FailureKind::timeout, FailureKind::cpu_limit, FailureKind::out_of_memory}) {
    EXPECT_TRUE(is_limit(kind));
  }
  for (const FailureKind kind : {FailureKind::none, FailureKind::crashed, FailureKind::error,
                                 FailureKind::unsupported, FailureKind::quarantined}) {
    EXPECT_FALSE(is_limit(kind));
  }
}

TEST(Record, SaysThatTheClockEndedItsFit) {
  Record record;
  record.note = "first";
  EXPECT_FALSE(was_ended_by_clock(record));
  note_end_by_clock(record);
  EXPECT_EQ(record.note, "first; ended by the clock: not reproducible");
  EXPECT_TRUE(was_ended_by_clock(record));
}

TEST(Record, HasTheCostsOfAFurtherSearchAndThatTheClockEndedIt) {
  Record record;
  record.fit_cpu_s = 2;
  record.evaluations = 100;
  record.peak_memory_mib = 50;
  Record further = record;
  further.peak_memory_mib = 40;
  note_end_by_clock(further);
  add_costs(record, further);
  EXPECT_EQ(record.fit_cpu_s, 4);
  EXPECT_EQ(record.evaluations, 200U);
  EXPECT_EQ(record.peak_memory_mib, 50);
  EXPECT_EQ(record.note, "ended by the clock: not reproducible");
  add_costs(record, further);
  EXPECT_EQ(record.note, "ended by the clock: not reproducible");
}

TEST(Record, SaysHowMuchAFitTookBeyondItsBudget) {
  Record record;
  record.note = "first";
  record.evaluations = 109;
  // A tenth is the clock's grain and half a second a program's start.
  for (const auto& [spent, budget] : {std::pair{21.9, 20.0}, std::pair{1.4, 1.0}}) {
    record.fit_cpu_s = spent;
    note_overspending(record, budget, 100);
    EXPECT_EQ(record.note, "first");
  }
  record.fit_cpu_s = 12.04;
  record.evaluations = 5000;
  note_overspending(record, 1, 100);
  note_end_by_clock(record);
  EXPECT_EQ(
      record.note,
      "first; over budget: 12.0 of 1 CPU seconds; over budget: 5000 of 100 evaluations; ended "
      "by the clock: not reproducible");
  // Seconds are never the same twice; what was claimed is.
  forget_costs(record);
  EXPECT_EQ(record.note,
            "first; over budget: 5000 of 100 evaluations; ended by the clock: not reproducible");
}

}  // namespace
}  // namespace tribench
