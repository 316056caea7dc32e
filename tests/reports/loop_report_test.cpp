// SPDX-License-Identifier: MIT
#include "reports/loop_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(LoopReport, IsByteForByteWhatWasAgreed) {
  expect_golden(loop_markdown(sample_loop(), "joint 2"), "reports/loop.md");
}

TEST(LoopReport, SaysPlainlyThatNothingIsMissing) {
  EXPECT_THAT(loop_markdown(json{{"verdict", "NONE"}, {"candidates", json::array()}}, "x"),
              HasSubstr("these data can test none of the effects"));
  EXPECT_THAT(loop_markdown(json{{"verdict", "NONE"}}, "x"),
              HasSubstr("Nothing is missing: the residual shows no structure."));
}

TEST(LoopReport, SurvivesEveryKeyOfAnotherKind) {
  const json whole = sample_loop();
  for (const auto& [key, value] : whole.items()) {
    for (const json& other :
         {json(nullptr), json(1), json("x"), json::array({1, nullptr}), json{{"a", 1}}}) {
      json spoilt = whole;
      spoilt[key] = other;
      EXPECT_NO_THROW(loop_markdown(spoilt, "x")) << key << " " << other;
    }
    json without = whole;
    without.erase(key);
    EXPECT_NO_THROW(loop_markdown(without, "x")) << key;
  }
}

TEST(LoopReport, WritesBesideTheJson) {
  const auto folder = fresh_folder("loop");
  write_loop_report(sample_loop(), "joint 2", folder);
  EXPECT_THAT(text_of(folder / "loop.md"), HasSubstr("Closing the loop: joint 2"));
}

}  // namespace
}  // namespace tribench
