// SPDX-License-Identifier: MIT
#include "reports/record/loop_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

// Programs read it: every name and every figure, its pictures' too.
TEST(LoopJson, IsByteForByteWhatWasAgreed) {
  expect_golden(loop_json(sample_loop()).dump(2) + "\n", "reports/loop.json");
  LoopRecord record = sample_loop();
  LoopPictures& pictures = record.pictures;
  pictures.friction.series.resize(1);
  pictures.traces.resize(1);
  pictures.movements.resize(2);
  for (std::vector<double>* values : {&pictures.traces[0].x, &pictures.traces[0].measured,
                                      &pictures.traces[0].before, &pictures.traces[0].after}) {
    values->resize(3);
  }
  expect_golden(loop_pictures_json(record).dump(1) + "\n", "reports/loop_pictures.json");
}

TEST(LoopJson, HasNullForWhatIsNotKnown) {
  LoopRecord record = sample_loop();
  EXPECT_EQ(loop_json(record)["error"]["attainable"], 0.2);
  record.error.attainable = kNoFigure;
  EXPECT_TRUE(loop_json(record)["error"]["attainable"].is_null());
  EXPECT_EQ(loop_json(record)["verdict"], "UNKNOWN");
}

TEST(LoopJson, SpeaksOfMotionOnlyWhereItWasSimulated) {
  LoopRecord record = sample_loop();
  EXPECT_FALSE(loop_json(record).contains("motion"));
  record.motion.before = 0.2;
  record.motion.after = 0.1;
  EXPECT_EQ(loop_json(record)["motion"]["after"], 0.1);
}

TEST(LoopJson, HasAStiffnessWhereBristlesWereFitted) {
  LoopRecord record = sample_loop();
  EXPECT_FALSE(loop_json(record)["effects"][0].contains("bristles"));
  record.effects[0].bristles = {.law = "dahl", .stiffness = 40, .stiffness_unit = "N m/rad"};
  const auto json = loop_json(record)["effects"][0]["bristles"];
  EXPECT_EQ(json["stiffness"], 40);
  EXPECT_EQ(json["unit"], "N m/rad");
  EXPECT_TRUE(json["hi"].is_null());
}

// Five digits of the largest: more than a picture shows.
TEST(LoopJson, RoundsTheSeriesOfPictures) {
  LoopRecord record = sample_loop();
  record.pictures.friction.series.resize(1);
  record.pictures.friction.series[0].x = {1, 0.123456789, kNoFigure};
  const auto x = loop_pictures_json(record)["friction"]["series"][0]["x"];
  EXPECT_EQ(x[0], 1);
  EXPECT_EQ(x[1], 0.12346);
  EXPECT_TRUE(x[2].is_null());
  // Of the largest, however small that is.
  record.pictures.friction.series[0].x = {1e-6, 1.23456789e-7};
  EXPECT_EQ(loop_pictures_json(record)["friction"]["series"][0]["x"][1], 1.2346e-7);
}

}  // namespace
}  // namespace tribench
