// SPDX-License-Identifier: MIT
#include "problems/reading/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "tests/support/paths.hpp"

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
        std::string_view("\"v\",\"y\"\n\"1\",\"2\"\n3,4\n"), std::string_view("v|y\n1|2\n3|4\n"),
        std::string_view("v y\n1 2\n3  4\n"), std::string_view("v;y;\n1;2;\n3;4;\n"),
        std::string_view("v;y\n1,0;2,0\n3,0;4,0\n"), std::string_view("v,y\n\n1,2\n\n3,4\n"),
        std::string_view("# robot 7\nv,y\n1,2\n# a pause\n3,4\n"),
        std::string_view("# v, y\n1, 2\n3, 4\n"), std::string_view("run of May\nv,y\n1,2\n3,4\n"),
        std::string_view("\"v\",\"y\"\n\"1,0\",\"2,0\"\n\"3,0\",\"4,0\"\n")}) {
    const Dataset data = parse_csv(text, "data.csv").data;
    ASSERT_EQ(data.channels.size(), 2U) << text;
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_EQ(data.channels[j].name, expected.channels[j].name) << text;
      EXPECT_EQ(data.channels[j].values, expected.channels[j].values) << text;
    }
  }
}

TEST(Csv, WhatPartsTheRowsPartsTheNamesWhateverTheseHold) {
  // A name that is a number, and semicolons in a quoted one.
  const DataFile file = parse_csv("0.31,\"a;b;c;d\",e\n1,2,3\n4,5,6\n", "log.csv");
  ASSERT_EQ(file.data.channels.size(), 3U);
  EXPECT_EQ(file.data.channels[1].name, "a;b;c;d");
  EXPECT_EQ(file.data.channels[1].values, (std::vector<double>{2, 5}));
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
  EXPECT_THAT(complaint("v,y\n1,1e999\n2,3\n"), HasSubstr("data.csv:2:y: '1e999'"));
}

// FLT_MAX, DBL_MAX and their like mark a missing value.
TEST(Csv, ANumberBeyondWhatIsMeasuredIsAMissingValue) {
  for (const std::string marker : {"1.797e308", "-3.4e38", "1e999"}) {
    EXPECT_THAT(complaint("v,tau_f\n1," + marker + "\n2,3\n"),
                AllOf(HasSubstr("data.csv:2:tau_f: '" + marker + "' is too large"),
                      HasSubstr("--drop-missing")));
    const DataFile file = parse_csv("v,tau_f\n1," + marker + "\n2,3\n", "data.csv", {{}, true});
    EXPECT_EQ(file.dropped_rows, 1U);
    EXPECT_EQ(file.data.rows(), 1U);
  }
  // What nobody calls a torque may be any quantity in any unit.
  EXPECT_EQ(parse_csv("v,y\n1,1e60\n2,-1e-300\n", "data.csv").data.rows(), 2U);
}

TEST(Csv, DroppedRowsAreCounted) {
  CsvOptions options;
  options.drop_missing = true;
  const DataFile reading =
      parse_csv("movement,v,y\na,1,2\na,,3\na,nan,4\n,1,1\nb,5,6\n\nb,7,8\n", "data.csv", options);
  EXPECT_EQ(reading.dropped_rows, 3U);  // a blank line is no row
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
  EXPECT_THAT(complaint("v,y\n1,5,2\n"), HasSubstr("decimal comma"));
  EXPECT_THAT(complaint("v,y\n\"1,2\n"), HasSubstr("data.csv:2: a quote"));
  EXPECT_THAT(complaint("v,y\n\"1\"x,2\n"), HasSubstr("follows a closing quote"));
  EXPECT_THAT(complaint(std::string_view("v\0,y\n", 5)), HasSubstr("zero byte"));
}

TEST(Csv, AColumnOfTextIsSaidToHoldText) {
  const DataFile reading = parse_csv("lab,y\n,1\ntrue,2\nfalse,3\n", "data.csv");
  try {
    reading.data.at("lab");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("data.csv:3:lab: column 'lab' holds text: 'true'"),
                                    HasSubstr("name a column of numbers")));
  }
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

TEST(Csv, ARoleMayNameItsColumnWithoutTheUnitBehindIt) {
  CsvOptions options;
  options.roles = parse_roles("Lage=position,Strom=motor_current[mA]", "--roles");
  const DataFile file = parse_csv("Lage [deg],Strom (mA)\n90,1500\n", "data.csv", options);
  EXPECT_EQ(file.data.at("Lage [deg]").role, Role::position);
  EXPECT_NEAR(file.data.at("Lage [deg]").values[0], M_PI / 2, 1e-15);
  EXPECT_EQ(file.data.at("Strom (mA)").role, Role::motor_current);
  // Where that leaves two to choose from, or both are named, it stands for neither.
  EXPECT_THAT(complaint("Strom [A],Strom (mA)\n1,2\n", options), HasSubstr("no column 'Lage'"));
  options.roles = parse_roles("Strom=motor_current", "--roles");
  EXPECT_THAT(complaint("Strom [A],Strom (mA)\n1,2\n", options), HasSubstr("no column 'Strom'"));
  options.roles = parse_roles("Strom=motor_current,Strom [A]=motor_current", "--roles");
  EXPECT_THAT(complaint("Strom [A],q\n1,2\n", options), HasSubstr("no column 'Strom'"));
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

TEST(Csv, ConvertsChannelsWithARoleAndSaysSo) {
  const DataFile file = parse_csv(
      "stamp,q [deg],w,i_mA,T [K],x_deg\n"
      "1700000000000000000,90,60,1500,300,90\n1700000000001000000,-180,-60,-500,310,1\n",
      "log.csv", {parse_roles("w=velocity[rpm@motor]", "--roles"), false, true, {}, {}, {{}, 10}});
  const Dataset& data = file.data;
  EXPECT_EQ(data.at("stamp").values[0], 0);
  EXPECT_NEAR(data.at("stamp").values[1], 1e-3, 3e-7);
  EXPECT_NEAR(data.at("q [deg]").values[0], M_PI / 2, 1e-15);
  EXPECT_EQ(data.at("q [deg]").unit, "rad");
  EXPECT_NEAR(data.at("w").values[0], 2 * M_PI / 10, 1e-15);
  EXPECT_NEAR(data.at("i_mA").values[1], -0.5, 1e-15);
  EXPECT_NEAR(data.at("T [K]").values[0], 26.85, 1e-12);
  EXPECT_EQ(data.at("x_deg").values[0], 90);  // without a role it stays as it is
  EXPECT_EQ(file.readings[0].unit_from, "size");
  EXPECT_EQ(file.readings[2].unit, "rpm@motor");
}

// A double holds a second since 1970 to a quarter of a microsecond, a nanosecond to 256.
TEST(Csv, StepsSince1970AreAsTheyWereWritten) {
  std::string seconds = "time_s,position_rad\n";
  std::string nanoseconds = "time_ns,position_rad\n";
  for (int i = 0; i < 400; ++i) {
    seconds += fmt::format("17000000{:02}.{:03},0.1\n", (5 * i + 100) / 1000, (5 * i + 100) % 1000);
    nanoseconds += fmt::format("{},0.1\n", 1'700'000'000'100'000'000 + 5'000'000LL * i);
  }
  for (const std::string& text : {seconds, nanoseconds}) {
    const DataFile file = parse_csv(text, "log.csv");
    const std::vector<double>& time = file.data.channels[0].values;
    for (int i = 0; i < 400; ++i)
      EXPECT_DOUBLE_EQ(time[static_cast<std::size_t>(i)], 5 * i / 1000.0);
  }
}

TEST(Csv, SecondsAndNanosecondsOfAStampAreOneTime) {
  const DataFile file = parse_csv(
      "header.stamp.sec,header.stamp.nanosec,position\n"
      "1700000000,999000000,0.1\n1700000001,1000000,0.2\n",
      "bag.csv");
  ASSERT_EQ(file.data.channels.size(), 2U);
  EXPECT_NEAR(file.data.channels[0].values[1] - file.data.channels[0].values[0], 0.002, 1e-9);
}

TEST(Csv, AStampInTwoColumnsIsTheTimeBesideARecordersOwn) {
  const DataFile file = parse_csv(
      "Time,header.stamp.secs,header.stamp.nsecs,position\n"
      "1700000009.2,1700000000,999000000,0.1\n1700000009.3,1700000001,1000000,0.2\n",
      "bag.csv");
  const Channel* time = file.data.find(Role::time);
  ASSERT_NE(time, nullptr);
  EXPECT_EQ(time->name, "header.stamp.secs");
  EXPECT_NEAR(time->values[1] - time->values[0], 0.002, 1e-9);
}

TEST(Csv, ARowOfUnitsCountsMoreThanWhatASourceUsuallyMeans) {
  const DataFile file =
      parse_csv("time;position;velocity\n[ms];[deg];[deg/s]\n0;1,5;2\n10;3;4\n", "log.csv");
  EXPECT_EQ(file.data.rows(), 2U);
  EXPECT_NEAR(file.data.at("time").values[1], 0.01, 1e-15);
  EXPECT_NEAR(file.data.at("position").values[0], 1.5 * M_PI / 180, 1e-15);
}

TEST(Csv, NamesTellNothingWhereTheyAreNotAsked) {
  CsvOptions options;
  options.names_tell = false;
  options.used = {{"t", "movement"}};
  // A column t that is no time, a movement that is a number, an unused column full of gaps.
  const DataFile file =
      parse_csv("t,movement,time_s,x\n3,1,5,nan\n1,2,4,1e300\n2,1,6,abc\n", "d.csv", options);
  ASSERT_EQ(file.data.channels.size(), 2U);
  EXPECT_EQ(file.data.at("t").role, Role::none);
  EXPECT_EQ(file.data.at("movement").values, (std::vector<double>{1, 2, 1}));
}

TEST(Csv, SpareColumnsAreThoseWithANumberInEveryRow) {
  CsvOptions options;
  options.used = std::vector<std::string>();
  options.spare = true;
  options.roles = parse_roles("known=none", "--roles");
  const std::string text =
      "time_s,load,gap,word,huge,known,target_current_A,kg\n"
      "0,1,1,1,1,1,1,5e-1\n"
      "1,+2,,2,1e200,2,2,6\n"
      "2,\"3\",3,x,1,3,3,7\n";
  const DataFile file = parse_csv(text, "d.csv", options);
  EXPECT_EQ(file.spare, (std::vector<std::string>{"load", "kg"}));
  ASSERT_EQ(file.data.channels.size(), 3U);
  EXPECT_EQ(file.data.at("load").values, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(file.data.at("load").role, Role::none);
  EXPECT_EQ(file.data.at("kg").values, (std::vector<double>{0.5, 6, 7}));
  options.spare = false;
  EXPECT_EQ(parse_csv(text, "d.csv", options).data.channels.size(), 1U);
  // They are no data by themselves.
  options.spare = true;
  options.roles = {};
  EXPECT_THAT(complaint("c0,c1\n1,2\n2,4\n", options), HasSubstr("no column's name is known"));
}

TEST(Csv, ColumnsThatNoNameTellsAreNotSaidToHoldNoNumbers) {
  CsvOptions options;
  options.used = std::vector<std::string>();
  EXPECT_THAT(complaint("c0,c1\n1,2\n2,4\n", options),
              AllOf(HasSubstr("no column's name is known: c0, c1;"), HasSubstr("--roles 'c0=")));
  EXPECT_THAT(complaint("c0,c1\nup,down\nleft,right\n"), HasSubstr("no column holds numbers"));
  std::string wide = "c0";
  for (int i = 1; i < 1000; ++i) wide += ",c" + std::to_string(i);
  EXPECT_LT(complaint(wide + "\n" + wide, options).size(), 600U);
}

TEST(Csv, AUnitThatNobodyKnowsIsRefused) {
  EXPECT_THAT(complaint("time_s,q [furlong]\n0,1\n"),
              HasSubstr("'furlong' is no unit of a position"));
  EXPECT_THROW(parse_roles("q=position[rpm]", "--roles"), Error);
  EXPECT_THROW(parse_roles("q=position[deg@wheel]", "--roles"), Error);
  EXPECT_THROW(parse_roles("q=position,q=velocity", "--roles"), Error);
}

TEST(Csv, ALastLineThatIsCutOffIsLeftOutAndNoted) {
  const DataFile file = parse_csv("v,y\n1,2\n3,4\n5", "d.csv");
  EXPECT_EQ(file.data.rows(), 2U);
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_THAT(file.warnings[0], HasSubstr("cut off"));
}

// The digit behind it went with it, as if it were a delimiter.
TEST(Csv, ACarriageReturnWithinARowIsNoEndOfACell) {
  const auto rows_of = [](const char* text) { return parse_csv(text, "data.csv").data; };
  EXPECT_THROW(rows_of("t,y\n1,2\n4,5\r3\n"), Error);
  EXPECT_THROW(rows_of("t,y\n1,2\n4\r3,5\n"), Error);
  EXPECT_EQ(rows_of("t,y\r\n1,2\r\n4,5\r").at("y").values, (std::vector<double>{2, 5}));
  EXPECT_EQ(rows_of("t,y\r\r\n1,2\r\r\n4,5\r\r\n").at("y").values, (std::vector<double>{2, 5}));
}

TEST(Csv, AHundredThousandColumnsAreReadInTimeThatGrowsWithTheirNumber) {
  std::string names = "c0";
  std::string row = "0";
  for (int j = 1; j < 100'000; ++j) {
    names += ",c" + std::to_string(j);
    row += ",1";
  }
  CsvOptions options;
  options.names_tell = false;
  options.used = {{"c7"}};
  const std::clock_t begin = std::clock();
  const DataFile file = parse_csv(names + "\n" + row + "\n" + row + "\n", "wide.csv", options);
  EXPECT_EQ(file.data.channels.size(), 1U);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5);
}

TEST(Csv, GzipIsUnpackedAndDamageNamed) {
  const std::filesystem::path file = testing::scratch_folder() / "packed.csv.gz";
  gzFile out = gzopen(file.c_str(), "wb");
  const std::string text = "v,y\n1,2\n3,4\n";
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  EXPECT_EQ(read_csv(file).data.at("y").values, (std::vector<double>{2, 4}));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 9);
  EXPECT_THROW(read_csv(file), Error);
  std::filesystem::remove(file);
}

TEST(Csv, FilesThatAreNotThereAreNamed) {
  EXPECT_THROW(read_csv("no/such/file.csv"), Error);
  EXPECT_THROW(read_csv("."), Error);
  EXPECT_THROW(read_csv_files({}), Error);
}

TEST(Csv, AValueThatBreaksTheRuleIsRefusedWithItsLine) {
  const auto refusal = [](const std::string& text, bool zero_too) -> std::string {
    CsvOptions options;
    options.drop_missing = true;
    const auto holds = [=](double w) { return w > 0 || (w == 0 && zero_too); };
    options.rule = ColumnRule{"w", holds, "weights are so"};
    try {
      parse_csv(text, "f.csv", options);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("# a note\nx,w\n1,1\n2,\n3,-2\n", true),
            "f.csv:5:w: '-2' cannot be used; weights are so");
  EXPECT_EQ(refusal("x,w\n1,1\n-2,0\n", true), "accepted");
  EXPECT_EQ(refusal("x,w\n1,1\n-2,0\n", false), "f.csv:3:w: '0' cannot be used; weights are so");
}

}  // namespace
}  // namespace tribench
