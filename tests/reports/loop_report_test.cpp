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
using ::testing::Not;

TEST(LoopReport, IsByteForByteWhatWasAgreed) {
  expect_golden(loop_markdown(sample_loop(), "joint 2"), "reports/loop.md");
}

TEST(LoopReport, SaysPlainlyThatNothingIsMissing) {
  EXPECT_THAT(loop_markdown(json{{"verdict", "NONE"}, {"candidates", json::array()}}, "x"),
              HasSubstr("these data can test none of the effects"));
  EXPECT_THAT(loop_markdown(json{{"verdict", "NONE"}}, "x"),
              HasSubstr("Nothing is missing: the residual shows no structure."));
}

TEST(LoopReport, DoesNotPassSilenceOfTheDataForAnAnswer) {
  json loop = {{"verdict", "NONE"},
               {"candidates", {{{"family", "lag"}}}},
               {"untestable", {{{"family", "lag"}, {"reason", "no acceleration"}}}},
               {"warnings", {"all movement is in one direction"}},
               {"notes", {"there are 4 movements"}}};
  const std::string text = loop_markdown(loop, "x");
  EXPECT_THAT(text, HasSubstr("Nothing is missing that these data can show"));
  EXPECT_THAT(text, HasSubstr("no acceleration"));
  EXPECT_THAT(text, HasSubstr("- all movement is in one direction."));
  EXPECT_THAT(text, HasSubstr("- there are 4 movements."));
}

TEST(LoopReport, SaysWhatSpeaksAgainstAFinding) {
  json loop = sample_loop();
  loop["error"]["confirmed"] = false;
  EXPECT_THAT(loop_markdown(loop, "x"), HasSubstr("held-out movements do not confirm"));
  loop["effects"][1]["not_physical"] = "a share of the load above 20 %";
  loop["effects"][1]["notes"] = {"carried by few movements"};
  loop["leftover"]["p"] = 0.7;
  const std::string text = loop_markdown(loop, "x");
  EXPECT_THAT(text, HasSubstr("not physical (a share of the load above 20 %)"));
  EXPECT_THAT(text, HasSubstr("; carried by few movements."));
  EXPECT_THAT(text, HasSubstr("an effect fits there that cannot be physical"));
  EXPECT_THAT(text, Not(HasSubstr("p = 0.70")));
}

TEST(LoopReport, ListsWhatCannotBeToldApartBurstsAndTheNextMovements) {
  json loop = sample_loop();
  loop["aliased"] = {
      {{"families", {"payload", "power_quadrant_gain"}}, {"corr", 0.999}, {"separate_by", "R3"}}};
  loop["next_movements"] = {{{"kind", "constant"},
                             {"velocity", 0.1},
                             {"from", -1},
                             {"to", 1},
                             {"load_factor", 1.5},
                             {"separation", 3.2},
                             {"between", "payload | power_quadrant_gain"}}};
  const std::string text = loop_markdown(loop, "x");
  EXPECT_THAT(text, HasSubstr("cannot tell apart"));
  loop["effects"][0]["alias"] = {{{"family", "sensor_offset"},
                                  {"exact", true},
                                  {"separate_by", "read the torque with the drive unpowered"}}};
  EXPECT_THAT(loop_markdown(loop, "x"),
              HasSubstr("cannot be told from sensor_offset (to settle that: read the torque with "
                        "the drive unpowered) at all"));
  EXPECT_THAT(text, HasSubstr("a known payload (R3)"));
  EXPECT_THAT(text, HasSubstr("movement 17, 1.20 to 1.30 s"));
  EXPECT_THAT(text, HasSubstr("## Next movements"));
  EXPECT_THAT(text, HasSubstr("| constant |"));
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
