// SPDX-License-Identifier: MIT
#include "reports/loop_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "reports/loop_words.hpp"
#include "reports/record/loop_json.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

std::ptrdiff_t lines_of(const std::string& text) { return std::ranges::count(text, '\n'); }

// A word of the program (load_coulomb) or a code (R4) that people were not meant to see.
std::string first_code(const std::string& text) {
  static const std::regex kCode(R"([a-z]+_[a-z_]+|\bR[1-9]\b)");
  std::smatch found;
  return std::regex_search(text, found, kCode) ? found.str() : std::string();
}

LoopRecord with(LoopVerdict verdict) {
  LoopRecord record = sample_loop();
  record.verdict = verdict;
  if (verdict != LoopVerdict::unknown) record.leftover.inputs.clear();
  if (verdict == LoopVerdict::none || verdict == LoopVerdict::cannot_tell) record.effects.clear();
  if (verdict == LoopVerdict::cannot_tell) record.needed = {"20 stretches of movement"};
  return record;
}

TEST(LoopReport, IsByteForByteWhatWasAgreed) {
  expect_golden(loop_markdown(sample_loop()), "reports/loop.md");
}

TEST(LoopWords, AnswerWhatHowMuchHowSureAndWhatNext) {
  const LoopWords words = loop_words(with(LoopVerdict::effects));
  EXPECT_EQ(words.headline,
            "Friction falls with speed near standstill and losses differ between driving and "
            "back-driving, in proportion to the load.");
  EXPECT_EQ(words.error,
            "Mean error 0.8100 -> 0.2400 N m on movements that it never saw (better by 0.49 to "
            "0.63); at most 0.050 N m more can be had.");
  ASSERT_EQ(words.cards.size(), 2U);
  EXPECT_EQ(words.cards[0].amount, "0.3100 N m");
  EXPECT_EQ(words.cards[0].share, "3 % of friction");
  EXPECT_EQ(words.cards[0].grade, "very sure");
  EXPECT_EQ(words.cards[0].settle, "");  // there is nothing to settle
  EXPECT_EQ(words.cards[1].grade, "provisional");
  EXPECT_EQ(words.cards[1].rivals, "It could also be payload error.");
  EXPECT_EQ(words.cards[1].settle, "To settle it: use two postures or a known payload.");
  EXPECT_THAT(words.next, HasSubstr("use two postures or a known payload"));
}

TEST(LoopWords, SayOfALargeErrorInNoneThatItMayHaveACauseInTime) {
  LoopRecord record = with(LoopVerdict::none);
  record.error.mae_before = record.error.mae_after = 2.1;
  record.error.ceiling = 0.18;
  EXPECT_THAT(loop_words(record).error, HasSubstr("1.9 N m of it lasts from row to row"));
  EXPECT_THAT(loop_words(record).error, Not(HasSubstr("can be had")));
  record.error.ceiling = 1.9;
  EXPECT_THAT(loop_words(record).error, HasSubstr("can be had"));
}

TEST(LoopWords, SayHowStiffBristlesAre) {
  LoopRecord record = sample_loop();
  EXPECT_EQ(loop_words(record).cards[0].bristles, "");
  LoopBristles& bristles = record.effects[0].bristles;
  bristles = {.law = "dahl",
              .stiffness = 40.25,
              .stiffness_low = 37,
              .stiffness_high = 44,
              .stiffness_unit = "N m/rad",
              .sliding = 0.025,
              .sliding_unit = "rad"};
  EXPECT_EQ(loop_words(record).cards[0].bristles,
            "As bristles: stiffness 40.25 N m/rad (37.0 .. 44.0), sliding from 0.0250 rad on.");
  bristles.mae_after = 0.5 * record.error.mae_after;
  EXPECT_NE(loop_words(record).cards[0].bristles.find("with them as a state the error is"),
            std::string::npos);
}

TEST(LoopWords, HaveAFaceForEveryVerdict) {
  EXPECT_EQ(loop_words(with(LoopVerdict::none)).headline,
            "Nothing is missing that these data can show.");
  EXPECT_THAT(loop_words(with(LoopVerdict::none)).detectable,
              HasSubstr("Stribeck effect above 0.050 N m"));
  LoopRecord sizeless = with(LoopVerdict::none);
  for (LoopCandidate& one : sizeless.candidates) {
    one.detectable = std::numeric_limits<double>::infinity();
  }
  EXPECT_THAT(loop_words(sizeless).detectable,
              HasSubstr("from which size on they would show: Stribeck"));
  LoopRecord in_part = with(LoopVerdict::none);
  in_part.steps.push_back({"acceleration resolved", 5000, "in 760 of 5760 rows it is not"});
  EXPECT_THAT(loop_words(in_part).detectable,
              ::testing::EndsWith("Not looked at: in 760 of 5760 rows it is not."));
  EXPECT_THAT(loop_words(with(LoopVerdict::none)).detectable,
              HasSubstr("Not looked at: ripples of more than 1257 waves a turn, unless"));
  LoopRecord linear = with(LoopVerdict::none);
  linear.shortest_wave = 0.0005;
  linear.shortest_wave_unit = "m";
  EXPECT_THAT(loop_words(linear).detectable, HasSubstr("ripples of less than 0.5000 mm, unless"));
  LoopRecord unknown = with(LoopVerdict::unknown);
  EXPECT_EQ(loop_words(unknown).leftover, "Still unexplained: something that depends on position.");
  unknown.leftover.chosen_share = 0.7;
  EXPECT_THAT(loop_words(unknown).leftover, HasSubstr(". Found again in 70 % of the repeats."));
  EXPECT_EQ(loop_words(with(LoopVerdict::cannot_tell)).next, "Record 20 stretches of movement.");
  LoopRecord nothing_to_test = with(LoopVerdict::none);
  nothing_to_test.candidates.clear();
  EXPECT_THAT(loop_words(nothing_to_test).headline, HasSubstr("can test none"));
  LoopRecord all_tested = with(LoopVerdict::none);
  all_tested.untestable.clear();
  EXPECT_EQ(loop_words(all_tested).headline, "Nothing is missing: what is left is noise.");
}

TEST(LoopWords, SayWhatSpeaksAgainstAFinding) {
  LoopRecord record = sample_loop();
  record.error.confirmed = false;
  record.effects[0].chosen_share = 0.7;
  record.effects[0].few_movements = true;
  record.effects[1].objection = "a share of the load above 20 %";
  record.effects[1].aliases[0] = {"sensor_offset", 1, 0, 0, true, "read the torque unpowered (R8)"};
  record.leftover.p = 0.7;
  const LoopWords words = loop_words(record);
  EXPECT_THAT(words.error, HasSubstr("do not confirm"));
  EXPECT_EQ(words.cards[0].grade, "likely");
  EXPECT_THAT(words.cards[0].doubts, ::testing::Contains(HasSubstr("Few movements")));
  record.effects[0].chosen_share = 1;
  EXPECT_THAT(loop_words(record).cards[0].doubts,
              ::testing::Not(::testing::Contains(HasSubstr("Few movements"))));
  EXPECT_EQ(words.cards[1].grade, "not physical");
  EXPECT_THAT(words.cards[1].doubts, ::testing::Contains(HasSubstr("above 20 %")));
  EXPECT_EQ(words.cards[1].rivals, "These data cannot tell it from sensor offset.");
  EXPECT_EQ(words.cards[1].settle, "To settle it: read the torque unpowered.");
  EXPECT_THAT(words.leftover, HasSubstr("cannot be physical"));
}

TEST(LoopWords, SayWhatDiffersFromMovementToMovement) {
  LoopRecord record = with(LoopVerdict::unknown);
  record.effects.clear();
  record.leftover.inputs = {"movement"};
  record.leftover.varying = {
      "coulomb_friction", 0.62, {{"m1", 0.5}, {"m2", -2}, {"m3", 0.1}, {"m4", 1}}};
  const LoopWords words = loop_words(record);
  EXPECT_THAT(words.headline, HasSubstr("Coulomb friction differs from movement to movement"));
  EXPECT_THAT(words.leftover, HasSubstr("most in 'm2' (-2"));
  EXPECT_THAT(words.leftover, HasSubstr("'m4' (1"));
  EXPECT_THAT(words.leftover, HasSubstr("'m1' (0.5"));
  EXPECT_THAT(words.leftover, ::testing::Not(HasSubstr("'m3'")));
  EXPECT_THAT(words.leftover, HasSubstr("62 % of what is left"));
  EXPECT_THAT(words.next, HasSubstr("what was changed between the movements"));
  const auto json = nlohmann::json::parse(write_loop_json(record));
  EXPECT_EQ(json["leftover"]["varying"]["term"], "coulomb_friction");
  EXPECT_EQ(json["leftover"]["varying"]["movements"][1]["torque"], -2);
}

// Beside an effect that is not physical what seems to differ is a doubt, and no verdict.
TEST(LoopWords, ADoubtIsNoVerdict) {
  LoopRecord record = with(LoopVerdict::unknown);
  record.effects.resize(1);
  record.effects[0].provisional = true;
  record.leftover.inputs = {"velocity"};
  record.leftover.varying = {"payload", 0.3, {{"m1", 0.5}}};
  const LoopWords words = loop_words(record);
  EXPECT_THAT(words.leftover, HasSubstr("depends on velocity"));
  record.leftover.inputs.clear();
  EXPECT_THAT(loop_words(record).cards[0].doubts,
              ::testing::Contains(HasSubstr("may stand for the payload")));
  record.leftover.varying.term = "coulomb_friction";
  EXPECT_EQ(plain_text(record, "'coulomb_friction' seems to differ"),
            "Coulomb friction seems to differ");
}

TEST(LoopWords, HoldNoNameOfTheProgramAndNoCode) {
  for (const LoopVerdict verdict :
       {LoopVerdict::none, LoopVerdict::effects, LoopVerdict::unknown, LoopVerdict::cannot_tell}) {
    const LoopRecord record = with(verdict);
    const LoopWords words = loop_words(record);
    std::string all = words.headline + words.error + words.leftover + words.next + words.detectable;
    for (const LoopCard& card : words.cards) {
      all += card.title + card.noun + card.sure + card.rivals + card.settle;
      for (const std::string& doubt : card.doubts) all += doubt;
    }
    for (const auto* list : {&words.untestable, &words.aliased, &words.bursts, &words.remarks}) {
      for (const std::string& line : *list) all += line;
    }
    EXPECT_EQ(first_code(all), "") << all;
    EXPECT_EQ(first_code(loop_terminal(record, false)), "");
  }
  EXPECT_EQ(plain_text(sample_loop(), "'stribeck' needs R3 (R4): see column 'a_b', x_y (--rows)"),
            "Stribeck effect needs use two postures or a known payload: see column 'a_b', x y");
}

TEST(LoopWords, ReadSmallTorquesInMilli) {
  LoopRecord record = with(LoopVerdict::effects);
  record.error.mae_before = 0.00014;
  record.error.mae_after = 0.00007;
  EXPECT_THAT(loop_words(record).error, HasSubstr("0.1400 -> 0.07000 mN m"));
  EXPECT_EQ(readable_unit("rad/s", 1e-6).name, "rad/s");
  EXPECT_EQ(length_unit("m", 0.0025).factor, 1000);
}

TEST(LoopTerminal, HasTwelveLinesAtMostAndColourOnlyWhereAsked) {
  LoopRecord record = sample_loop();
  for (int i = 0; i < 6; ++i) record.effects.push_back(record.effects[0]);
  record.needed = {"a", "b", "c"};
  const std::string plain = loop_terminal(record, false);
  EXPECT_LE(lines_of(plain), 12);
  EXPECT_THAT(plain, Not(HasSubstr("\033")));
  EXPECT_THAT(plain, HasSubstr("and 3 more"));
  EXPECT_THAT(loop_terminal(record, true), HasSubstr("\033[1m"));
}

TEST(LoopReport, IsTwoScreensHoweverMuchThereIs) {
  LoopRecord record = sample_loop();
  for (int i = 0; i < 60; ++i) {
    record.effects.push_back(record.effects[i % 2]);
    record.effects.resize(std::min<std::size_t>(record.effects.size(), 8));
    record.untestable.push_back({"inertia", "reason " + std::to_string(i), 0, 0, "R4"});
    record.aliased.push_back({"payload", "inertia", 0.99, "R3"});
    record.bursts.push_back(record.bursts[0]);
    record.warnings.push_back("a remark");
    record.next_movements.push_back({.kind = "two_tone", .between = "payload | gear_ripple"});
  }
  const std::string text = loop_markdown(record);
  EXPECT_LE(lines_of(text), 120);
  EXPECT_THAT(text, HasSubstr("cannot tell apart"));
  EXPECT_THAT(text, HasSubstr("## Next movements"));
  EXPECT_THAT(text, HasSubstr("Movement up slow, 1.20 to 1.30 s"));
  EXPECT_THAT(text, HasSubstr("| two tone |"));
}

TEST(LoopJson, KeepsTheKeysThatProgramsRead) {
  const json loop = json::parse(write_loop_json(sample_loop()));
  for (const char* key :
       {"verdict", "confirmed",      "target",     "alpha",   "seed",           "noise",
        "effects", "leftover",       "untestable", "aliased", "events",         "candidates",
        "needed",  "unused_columns", "error",      "base",    "base_formula",   "formula",
        "symbols", "notes",          "warnings",   "learned", "next_movements", "pictures"}) {
    EXPECT_TRUE(loop.contains(key)) << key;
  }
  EXPECT_EQ(loop["verdict"], "UNKNOWN");
  EXPECT_EQ(loop["effects"][1]["alias"][0]["family"], "payload");
  EXPECT_EQ(loop["effects"][0]["params"][0]["lo"], 1.1);
  EXPECT_TRUE(loop["effects"][0]["vif"].is_null());  // no figure
  EXPECT_EQ(loop["error"]["ci_diff"], (json{0.49, 0.63}));
  EXPECT_EQ(loop["pictures"]["residuals"][0]["effects"][0]["family"], "stribeck");
  EXPECT_EQ(loop["pictures"]["alias_map"]["correlation"][1][2], 0.95);
  EXPECT_EQ(loop["pictures"]["effects"][1]["series"].size(), 2U);
}

TEST(LoopReport, HoldsNoTagFromOutside) {
  LoopRecord record = sample_loop();
  record.title = "<img src=x onerror=alert(1)>\x1b[2J";
  const std::string text = loop_markdown(record);
  EXPECT_THAT(text, HasSubstr("# Closing the loop: &lt;img src=x onerror=alert(1)>?[2J\n"));
}

TEST(LoopReport, OfARecordWithoutFiguresSaysNothingOfThem) {
  const LoopRecord empty;
  EXPECT_THAT(loop_markdown(empty), Not(HasSubstr("nan")));
  EXPECT_THAT(loop_terminal(empty, false), HasSubstr("No error"));
  EXPECT_TRUE(json::parse(write_loop_json(empty))["error"]["mae_before"].is_null());
  EXPECT_NO_THROW(loop_html(empty));
}

TEST(LoopReport, WritesItsThreeFiles) {
  const auto folder = fresh_folder("loop");
  write_loop_report(sample_loop(), folder);
  EXPECT_THAT(text_of(folder / "loop.md"), HasSubstr("Closing the loop: joint 2"));
  EXPECT_THAT(text_of(folder / "loop.json"), HasSubstr("\"verdict\": \"UNKNOWN\""));
  EXPECT_THAT(text_of(folder / "loop.html"), HasSubstr("<title>Closing the loop: joint 2"));
}

}  // namespace
}  // namespace tribench
