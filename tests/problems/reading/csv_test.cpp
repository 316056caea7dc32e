// SPDX-License-Identifier: MIT
#include "problems/reading/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string complaint(std::string_view text, const CsvOptions& options = {}) {
  try {
    parse_csv(text, "data.csv", options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

TEST(Csv, ReadsRolesUnitsAndMovements) {
  const DataFile reading = parse_csv(
      "movement,time_s,velocity_rad_s,friction_torque_Nm\n"
      "up slow,0,0.25,9.5\n"
      "up slow,0.1,0.25,9.75\n"
      "down,0,-0.25,-1e1\n",
      "data.csv");
  const Dataset& data = reading.data;
  EXPECT_EQ(data.name, "data");
  EXPECT_EQ(data.movement_names, (std::vector<std::string>{"up slow", "down"}));
  EXPECT_EQ(data.movement, (std::vector<int>{0, 0, 1}));
  ASSERT_EQ(data.channels.size(), 3U);
  EXPECT_EQ(data.at("velocity_rad_s").role, Role::velocity);
  EXPECT_EQ(data.at("velocity_rad_s").unit, "rad/s");
  EXPECT_EQ(data.at("friction_torque_Nm").values, (std::vector<double>{9.5, 9.75, -10}));
}

TEST(Csv, AcceptsDelimitersByteOrderMarkCrlfAndAMissingLastNewline) {
  const std::string_view plain = "v,y\n1,2\n3,4\n";
  const Dataset expected = parse_csv(plain, "data.csv").data;
  for (const std::string_view text :
       {std::string_view("v;y\n1;2\n3;4\n"), std::string_view("v\ty\n1\t2\n3\t4\n"),
        std::string_view("\xEF\xBB\xBFv,y\n1,2\n3,4\n"), std::string_view("v,y\r\n1,2\r\n3,4\r\n"),
        std::string_view("v,y\n1,2\n3,4"), std::string_view("v,y\r\n1,2\r\n3,4"),
        std::string_view(" v , y \n 1 , 2 \n +3 , 4.0e0 \n\n\n"),
        std::string_view("\"v\",\"y\"\n\"1\",\"2\"\n3,4\n")}) {
    const Dataset data = parse_csv(text, "data.csv").data;
    ASSERT_EQ(data.channels.size(), 2U) << text;
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_EQ(data.channels[j].name, expected.channels[j].name) << text;
      EXPECT_EQ(data.channels[j].values, expected.channels[j].values) << text;
    }
  }
}

TEST(Csv, WithoutAMovementColumnTheFileIsOne) {
  const Dataset data = parse_csv("v,y\n1,2\n3,4\n", "runs/fast.csv").data;
  EXPECT_EQ(data.movement_names, (std::vector<std::string>{"fast"}));
  EXPECT_EQ(data.movement, (std::vector<int>{0, 0}));
}

TEST(Csv, AMissingValueIsNamedWithLineColumnAndMend) {
  EXPECT_THAT(complaint("v,y\n1,2\n3,\n"), HasSubstr("data.csv:3:y"));
  EXPECT_THAT(complaint("v,y\n1,2\n3,\n"), HasSubstr("empty"));
  EXPECT_THAT(complaint("v,y\n1,2\n3,\n"), HasSubstr("--drop-missing"));
  EXPECT_THAT(complaint("v,y\nNaN,2\n3,4\n"), HasSubstr("data.csv:2:v: 'NaN'"));
  EXPECT_THAT(complaint("v,y\n1,-inf\n"), HasSubstr("data.csv:2:y: '-inf'"));
  EXPECT_THAT(complaint("v,y\n1,2\n\n3,4\n"), HasSubstr("data.csv:3:v"));
  EXPECT_THAT(complaint("v,y\n1,1e999\n2,3\n"), HasSubstr("data.csv:2:y: '1e999'"));
}

// FLT_MAX, DBL_MAX and their like mark a missing value.
TEST(Csv, ANumberBeyondWhatIsMeasuredIsAMissingValue) {
  for (const std::string marker : {"1.797e308", "-3.4e38", "1e999"}) {
    EXPECT_THAT(complaint("v,y\n1," + marker + "\n2,3\n"),
                AllOf(HasSubstr("data.csv:2:y: '" + marker + "' is too large"),
                      HasSubstr("--drop-missing")));
    const DataFile file = parse_csv("v,y\n1," + marker + "\n2,3\n", "data.csv", {{}, true});
    EXPECT_EQ(file.dropped_rows, 1U);
    EXPECT_EQ(file.data.rows(), 1U);
  }
  EXPECT_EQ(parse_csv("v,y\n1,1e30\n2,-1e-300\n", "data.csv").data.rows(), 2U);
}

TEST(Csv, DroppedRowsAreCounted) {
  CsvOptions options;
  options.drop_missing = true;
  const DataFile reading =
      parse_csv("movement,v,y\na,1,2\na,,3\na,nan,4\n,1,1\nb,5,6\n\nb,7,8\n", "data.csv", options);
  EXPECT_EQ(reading.dropped_rows, 4U);
  EXPECT_EQ(reading.data.at("v").values, (std::vector<double>{1, 5, 7}));
  EXPECT_THAT(complaint("v\nnan\n", options), HasSubstr("all 1 rows"));
  // Text is a mistake, not a missing value.
  EXPECT_THAT(complaint("v,y\n1,2\nabc,3\n", options), HasSubstr("data.csv:3:v: 'abc'"));
}

TEST(Csv, ComplainsOfTheFileWithAPlaceAndAMend) {
  EXPECT_THAT(complaint(""), HasSubstr("empty"));
  EXPECT_THAT(complaint("\n\n"), HasSubstr("empty"));
  EXPECT_THAT(complaint("v,y\n"), HasSubstr("no row"));
  EXPECT_THAT(complaint("1,2\n3,4\n"), HasSubstr("names"));
  EXPECT_THAT(complaint("v,v\n3,4\n"), HasSubstr("two columns are named 'v'"));
  EXPECT_THAT(complaint("v,\n3,4\n"), HasSubstr("column 2 has no name"));
  EXPECT_THAT(complaint("v,y\n1,2,3\n"), HasSubstr("data.csv:2: 3 cells where the header has 2"));
  EXPECT_THAT(complaint("v,y\n1,2\n1\n"), HasSubstr("data.csv:3: 1 cell where"));
  EXPECT_THAT(complaint("v;y\n1,5;2\n"), HasSubstr("decimal point"));
  EXPECT_THAT(complaint("v,y\n\"1,2\n"), HasSubstr("data.csv:2: a quote"));
  EXPECT_THAT(complaint("v,y\n\"1\"x,2\n"), HasSubstr("follows a closing quote"));
  EXPECT_THAT(complaint(std::string_view("v\0,y\n", 5)), HasSubstr("zero byte"));
}

TEST(Csv, MovementsStandTogetherAndTimeRunsForward) {
  EXPECT_THAT(complaint("movement,v\na,1\nb,2\na,3\n"), HasSubstr("data.csv:4: movement 'a'"));
  EXPECT_THAT(complaint("time_s,v\n0,1\n1,2\n0.5,3\n"), HasSubstr("data.csv:4:time_s"));
  // Running through the campaign and restarting with each movement are both fine.
  EXPECT_EQ(parse_csv("movement,t,v\na,0,1\na,1,1\nb,0,1\n", "d.csv").data.rows(), 3U);
  EXPECT_EQ(parse_csv("movement,t,v\na,0,1\na,1,1\nb,2,1\n", "d.csv").data.rows(), 3U);
}

TEST(Csv, WhereTimeBeginsAnewTheColumnThatNamesTheRecordingsIsProposed) {
  const std::string numbers =
      "drive,set_speed,time_s,y\n1,2,0,1\n1,2,1,1\n1,5,0,1\n1,5,1,2\n1,2,0,1\n";
  EXPECT_THAT(complaint(numbers),
              AllOf(HasSubstr("data.csv:4:time_s"), HasSubstr("--roles set_speed=movement")));
  EXPECT_THAT(complaint("time_s,y,trial\n0,1,a\n1,2,a\n0,1,b\n"),
              HasSubstr("--roles trial=movement"));
  // A column that changes elsewhere too names nothing.
  EXPECT_THAT(complaint("time_s,y\n0,1\n1,2\n0,3\n"), HasSubstr("in a column 'movement'"));
}

TEST(Csv, GivenRolesWinAndUnknownColumnsAreAnsweredWithTheNearest) {
  CsvOptions options;
  options.roles = {{"speed", Role::velocity}, {"run", Role::movement}};
  const DataFile reading =
      parse_csv("run,speed,velocity_rad_s\n7,1,2\n8,1,2\n", "data.csv", options);
  EXPECT_EQ(reading.data.at("speed").role, Role::velocity);
  EXPECT_EQ(reading.data.at("velocity_rad_s").role, Role::none);
  EXPECT_EQ(reading.warnings.size(), 1U);
  EXPECT_EQ(reading.data.movement_names, (std::vector<std::string>{"7", "8"}));
  options.roles = {{"sped", Role::velocity}};
  EXPECT_THAT(complaint("speed,y\n1,2\n", options), HasSubstr("did you mean speed?"));
}

TEST(Csv, TorqueLikeColumnsShareOneUnit) {
  EXPECT_THAT(complaint("v,motor_torque_Nm,gravity_torque_A\n1,2,3\n"), HasSubstr("N m"));
  // A current beside a torque is what the torque was computed from, unless a role is given.
  const std::string_view both = "v,motor_current_A,motor_torque_Nm\n1,2,3\n";
  const DataFile reading = parse_csv(both, "d.csv");
  EXPECT_EQ(reading.data.at("motor_current_A").role, Role::none);
  EXPECT_EQ(reading.warnings.size(), 1U);
  CsvOptions options;
  options.roles = {{"motor_current_A", Role::motor_current}};
  EXPECT_THAT(complaint(both, options), HasSubstr("one unit"));
  EXPECT_EQ(parse_csv("v,motor_torque_V,gravity_torque_V\n1,2,3\n", "d.csv").data.rows(), 1U);
  // The load beside a motor's volts keeps its own unit.
  EXPECT_EQ(parse_csv("v,motor_torque_V,gravity_torque_Nm\n1,2,3\n", "d.csv").data.rows(), 1U);
}

TEST(Csv, ColumnsOfTextAreKeptApart) {
  const DataFile reading = parse_csv("trajectory,v\nslow,1\n\"fa;st\",2\n", "data.csv");
  ASSERT_EQ(reading.texts.size(), 1U);
  EXPECT_EQ(reading.texts[0].values, (std::vector<std::string>{"slow", "fa;st"}));
  EXPECT_EQ(reading.data.channels.size(), 1U);
  // A column with a role is never text.
  EXPECT_THAT(complaint("velocity_rad_s,y\nfast,1\n"), HasSubstr("data.csv:2:velocity_rad_s"));
}

TEST(Csv, WhatIsWrittenReadsBackBitForBit) {
  RandomStream random(11);
  Dataset data;
  data.channels = {{"velocity_rad_s", "rad/s", Role::velocity, {}}, {"y", "-", Role::none, {}}};
  data.movement_names = {"a", "b, \"quoted\"", " c"};
  for (int r = 0; r < 3000; ++r) {
    data.movement.push_back(r / 1000);
    data.channels[0].values.push_back(random.normal() * std::pow(10.0, random.uniform(-300, 29)));
    data.channels[1].values.push_back(random.normal());
  }
  data.channels[1].values[0] = std::numeric_limits<double>::denorm_min();
  data.channels[1].values[1] = -0.0;
  data.channels[1].values[2] = 1e30;
  std::ostringstream out;
  write_csv(data, out);
  const Dataset back = parse_csv(out.str(), "x.csv").data;
  EXPECT_EQ(back.movement_names, data.movement_names);
  EXPECT_EQ(back.movement, data.movement);
  for (std::size_t j = 0; j < 2; ++j) EXPECT_EQ(back.channels[j].values, data.channels[j].values);
}

// Whatever the bytes, the answer is a dataset that keeps its invariants or an Error.
void expect_answer(std::string_view text) {
  for (const bool drop : {false, true}) {
    CsvOptions options;
    options.drop_missing = drop;
    try {
      const DataFile reading = parse_csv(text, "fuzz.csv", options);
      ASSERT_GT(reading.data.rows(), 0U);
      for (const Channel& channel : reading.data.channels) {
        ASSERT_EQ(channel.values.size(), reading.data.rows());
        for (const double value : channel.values) ASSERT_TRUE(std::isfinite(value));
      }
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::bad_input);
      ASSERT_NE(std::string_view(error.what()), "");
    }
  }
}

TEST(Csv, AFileCutOffAtAnyByteOrWithAnyByteChangedIsAnswered) {
  const std::string text =
      "\xEF\xBB\xBFmovement,time_s,velocity_rad_s,\"friction, N\"\r\n"
      "\"a \"\"x\"\"\",0,-1.5e-3,+2\r\nb,0.1,nan,3\r\nb,0.2,1e999,4\r\n";
  for (std::size_t n = 0; n <= text.size(); ++n) expect_answer(text.substr(0, n));
  constexpr std::string_view kBytes("\0\n\r\t\",;-+.eE 9x\xFF", 16);
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char byte : kBytes) {
      std::string changed = text;
      changed[i] = byte;
      expect_answer(changed);
      changed = text;
      changed.insert(i, 1, byte);
      expect_answer(changed);
    }
  }
}

TEST(Csv, RandomBytesAreAnswered) {
  constexpr std::string_view kAlphabet = "v,;\t\n\r\"0123456789.eE+-naif_ \xC3";
  RandomStream random(5);
  for (int run = 0; run < 20000; ++run) {
    std::string text;
    const std::uint64_t length = random.below(60);
    for (std::uint64_t i = 0; i < length; ++i) text += kAlphabet[random.below(kAlphabet.size())];
    expect_answer(text);
  }
}

TEST(Csv, FilesThatAreNotThereAreNamed) {
  EXPECT_THROW(read_csv("no/such/file.csv"), Error);
  EXPECT_THROW(read_csv("."), Error);
  EXPECT_THROW(read_csv_files({}), Error);
}

}  // namespace
}  // namespace tribench
