// SPDX-License-Identifier: MIT
//
// Logs as drives, controllers, recorders and spreadsheets write them: each is read as what it is,
// or refused with the place and the mend; and the line of roles that is proposed reads the same
// again.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "foundation/error.hpp"
#include "foundation/scratch_folder.hpp"
#include "problems/preparation/data_options.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/explanation.hpp"
#include "problems/reading/time_text.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kDegree = M_PI / 180;

CsvOptions told(const std::string& roles, std::optional<int> joint = {}, Drive drive = {}) {
  CsvOptions options;
  options.roles = parse_roles(roles, "--roles");
  options.used.emplace();  // what has no role is not looked at, as for the loop
  options.joint = joint;
  options.drive = drive;
  return options;
}

struct Sample {
  double time;
  double position;
  double effort;  // torque or current
};

void expect_sample(const DataFile& file, std::size_t row, const Sample& sample) {
  const Channel* effort = file.data.find(Role::motor_torque);
  if (effort == nullptr) effort = file.data.find(Role::motor_current);
  ASSERT_NE(file.data.find(Role::time), nullptr);
  ASSERT_NE(file.data.find(Role::position), nullptr);
  ASSERT_NE(effort, nullptr);
  EXPECT_NEAR(file.data.find(Role::time)->values[row], sample.time, 1e-6);
  EXPECT_NEAR(file.data.find(Role::position)->values[row], sample.position, 1e-9);
  EXPECT_NEAR(effort->values[row], sample.effort, 1e-9);
}

// The file, its options and its second row; then the same with the roles that were proposed.
void expect_read(const std::string& text, const CsvOptions& options, const Sample& second) {
  const DataFile file = parse_csv(text, "log.csv", options);
  EXPECT_THAT(what_is_missing(file), ::testing::IsEmpty());
  expect_sample(file, 1, second);
  const DataFile again = parse_csv(text, "log.csv", told(roles_line(file), {}, options.drive));
  EXPECT_THAT(what_is_missing(again), ::testing::IsEmpty());
  EXPECT_EQ(roles_line(again), roles_line(file));
  expect_sample(again, 1, second);
}

std::string complaint_of_log(const std::string& text, const CsvOptions& options) {
  try {
    parse_csv(text, "log.csv", options);
  } catch (const Error& error) {
    return error.what();
  }
  return "read";
}

TEST(VendorLogs, Controllers) {
  // KUKA's sensor interface, joints numbered.
  expect_read(
      "Time[ms];AIPos.A1[deg];AIPos.A2[deg];MACur.A1[A];MACur.A2[A]\r\n"
      "0;1;90;0.5;2\r\n4;1;45;0.5;3\r\n",
      told("", 2), {0.004, 45 * kDegree, 3});
  // Universal Robots' recorder: blanks, seconds that no word names.
  expect_read(
      "timestamp target_q_0 actual_q_0 actual_q_1 actual_current_0 actual_current_1\n"
      "81234.512 0.1 0.1 0.2 1 2\n81234.514 0.1 0.1 0.3 1 4\n",
      told("", 1), {81234.514, 0.3, 4});
  // Kinova: torque and current side by side.
  expect_read(
      "time_s,actuator_position_deg,actuator_torque_Nm,actuator_current_motor_A,actuator_voltage\n"
      "0,10,5,1,24\n0.001,20,6,2,24\n",
      told(""), {0.001, 20 * kDegree, 6});
  // TwinCAT: lines of its own first, paths, decimal commas.
  expect_read(
      "TwinCAT Scope Export;Version 3.4\r\nAxis;Joint2\r\nSampleTime;2 ms\r\n\r\n"
      "Time [ms];MAIN.fbAxis.ActPos [\xC2\xB0];MAIN.fbAxis.ActTorque [Nm]\r\n"
      "0;1,5;2,5\r\n2;3,5;4,5\r\n",
      told(""), {0.002, 3.5 * kDegree, 4.5});
}

TEST(VendorLogs, Drives) {
  const double turn = 2 * M_PI;
  expect_read(
      "timestamp_s,axis0.encoder.pos_estimate [turns@motor],"
      "axis0.motor.current_control.Iq_measured [A]\n0,0,1\n0.001,4.5,2\n",
      told("", {}, {{}, 9}), {0.001, turn / 2, 2});
  expect_read("t_ms,id,present_position,present_current\n0,3,2048,10\n8,3,3072,20\n",
              told("present_position=position[counts],present_current=motor_current[2.69mA]", {},
                   {4096, {}}),
              {0.008, 0.75 * turn, 20 * 2.69e-3});
  expect_read("time_ms,0x6064,0x6077\n0,0,0\n2,65536,125\n",
              told("0x6064=position[counts@motor],0x6077=motor_torque[0.1%]", {}, {65536, 80}),
              {0.002, turn / 80, 12.5});
  // A counter of samples of 2 ms; a position counted the other way round.
  expect_read("sample,angle,iq_A\n0,0,1\n1,30,2\n",
              told("sample=time[2 ms],angle=position[-1 deg]"), {0.002, -30 * kDegree, 2});
}

TEST(VendorLogs, Recorders) {
  expect_read(
      "__time,/joint_states/joint_1/position,/joint_states/joint_1/effort,"
      "/joint_states/joint_2/position,/joint_states/joint_2/effort\n"
      "1715673153.250,0.1,1,0.2,2\n1715673153.252,0.1,1,0.3,4\n",
      told("", 2), {0.002, 0.3, 4});
  expect_read(
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.name0,field.position0,"
      "field.effort0\n1715673153000000000,0,1715673153000000000,,elbow,0.1,1\n"
      "1715673153002000000,1,1715673153002000000,,elbow,0.2,2\n",
      told(""), {0.002, 0.2, 2});
  const CsvOptions gaps = [] {
    CsvOptions options = told("");
    options.drop_missing = true;
    return options;
  }();
  EXPECT_THAT(complaint_of_log("__time,/js/position_deg,/drive/current_A\n0,1,\n0.001,,2\n", gaps),
              HasSubstr("instants of their own"));
}

TEST(VendorLogs, UnitsInOtherLanguagesAndUnitsSaidTwice) {
  expect_read(
      "Zeit [s];Istposition [Grad];Istgeschwindigkeit [Grad/s];Iststrom [A]\n0;90;1;1\n"
      "0,002;91;1;2\n",
      told(""), {0.002, 91 * kDegree, 2});
  expect_read("temps,p,v,c\n0,0.25,1,1\n2,0.5,1,2\n",
              told("temps=time[ms],p=position[rev],v=velocity[tr/min],c=motor_current[A_rms]"),
              {0.002, M_PI, 2});
  // A recorder that puts the unit behind names that hold it already.
  expect_read(
      "header.stamp.sec [s],header.stamp.nanosec [ns],q_deg [deg],tau [Nm]\n"
      "10,999000000,90,1\n11,1000000,91,2\n",
      told(""), {11.001, 91 * kDegree, 2});
  EXPECT_THAT(complaint_of_log("t,q_deg [rad],tau [Nm]\n0,1,1\n1,1,2\n", told("")),
              HasSubstr("'deg or rad' is no unit of a position"));
  expect_read("time_of_day [ms],seq [ms],q_rad,tau [Nm]\n36000000,0,1,1\n36000002,1,2,2\n",
              told(""), {36000.002, 2, 2});
}

TEST(VendorLogs, ARowOfUnitsMayHoldOneThatIsNotKnown) {
  const std::string names = "t;theta;omega;tau\n";
  const std::string rows = "0;90;1;1\n0.002;91;1;2\n";
  EXPECT_THAT(complaint_of_log(names + "s;zoll;rad/s;N m\n" + rows, told("")),
              ::testing::AllOf(HasSubstr("'zoll' is no unit of a position"),
                               HasSubstr("--roles 'theta=position[UNIT]'")));
  expect_read(names + "s;zoll;rad/s;N m\n" + rows, told("theta=position[deg]"),
              {0.002, 91 * kDegree, 2});
  // Nor is a unit that nobody knows the one that a name's source always uses.
  for (const char* text :
       {"t;q;effort\ns;rad;zoll\n0;1;1\n1;2;1\n", "t [s];q [rad];effort [zoll]\n0;1;1\n1;2;1\n"}) {
    const DataFile file = parse_csv(text, "log.csv", told(""));
    ASSERT_NE(file.data.find(Role::motor_torque), nullptr);
    EXPECT_EQ(file.data.find(Role::motor_torque)->unit, "-");
    EXPECT_THAT(file.readings.back().remark, HasSubstr("'zoll' is no unit that is known"));
  }
}

TEST(VendorLogs, TorquesInPoundsAndKilogramsAreConverted) {
  const std::pair<const char*, double> kUnits[] = {{"in-lb", 0.112985},
                                                   {"lbf_in", 0.112985},
                                                   {"lbf.ft", 1.35582},
                                                   {"oz-in", 0.0070616},
                                                   {"kgf cm", 0.0980665}};
  for (const auto& [unit, factor] : kUnits) {
    const std::string text = fmt::format("t [s];q [rad];effort [{}]\n0;1;10\n1;2;10\n", unit);
    const DataFile file = parse_csv(text, "log.csv", told(""));
    ASSERT_NE(file.data.find(Role::motor_torque), nullptr);
    EXPECT_EQ(file.data.find(Role::motor_torque)->unit, "N m") << unit;
    EXPECT_NEAR(file.data.find(Role::motor_torque)->values[0], 10 * factor, 1e-4 * factor) << unit;
  }
}

TEST(VendorLogs, EvenRowsWithoutATimeAreToldTheirRate) {
  CsvOptions options = told("pos=position[deg],tau=motor_torque[N m]");
  options.drop_missing = true;
  const std::string text = "pos,tau\n90,1\n,2\n91,3\n";
  EXPECT_THAT(what_is_missing(parse_csv(text, "log.csv", options)),
              ::testing::Contains(HasSubstr("--sample-rate HZ")));
  options.sample_rate = 500;
  const DataFile file = parse_csv(text, "log.csv", options);
  EXPECT_THAT(what_is_missing(file), ::testing::IsEmpty());
  // The row that is left out took its time.
  expect_sample(file, 1, {0.004, 91 * kDegree, 3});
  EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("a row every 0.002 s")));
  options.roles = parse_roles("pos=position[deg],t=time[s]", "--roles");
  EXPECT_THAT(complaint_of_log("t,pos\n0,90\n1,91\n", options),
              ::testing::AllOf(HasSubstr("'t' is a time already"), HasSubstr("'t=none'")));
}

TEST(VendorLogs, SpreadsheetsAndTheirEncodings) {
  const std::filesystem::path file = testing::scratch_folder() / "vendor";
  const auto read = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return read_csv(file, told(""));
  };
  const std::string text =
      "Zeit [s];Winkel [\xB0];Motorstrom [mA]\r\n0,000;1,5;20\r\n0,002;2,5;30\r\n";
  expect_sample(read(text), 1, {0.002, 2.5 * kDegree, 0.03});  // Latin-1
  std::string low_first = "\xFF\xFE";
  std::string high_first = "\xFE\xFF";
  for (const char c : text) {
    low_first += {c, '\0'};
    high_first += {'\0', c};
  }
  expect_sample(read(low_first), 1, {0.002, 2.5 * kDegree, 0.03});
  const DataFile wide = read(high_first);
  expect_sample(wide, 1, {0.002, 2.5 * kDegree, 0.03});
  EXPECT_EQ(wide.readings[1].column, "Winkel [\xC2\xB0]");
  std::filesystem::remove(file);
  expect_read("  tim   ang_deg  trq_Nm\n 0.0D+00  1.5D+01  2.0D+00\n 2.0D-03  3.0D+01 4.0D+00\n",
              told("tim=time"), {0.002, 30 * kDegree, 4});
}

TEST(VendorLogs, WhatARecorderSaysOfItselfIsNoRow) {
  const std::string rows = "0;0.1;1\n0.002;0.2;2\n0.004;0.3;3\n0.006;0.4;4\n";
  expect_read("Robot;KR 10\nSerial;4711\n\nt [s];q [rad];tau [Nm]\n" + rows, told(""),
              {0.002, 0.2, 2});
  expect_read("'t [s]';'q [rad]';'tau [Nm]'\n" + rows, told(""), {0.002, 0.2, 2});
  // A comment with a comma, above two columns with decimal commas.
  EXPECT_EQ(parse_csv("# joint: 3, payload: 2.5 kg\nq [rad];tau [Nm]\n0,1;1,5\n0,2;2,5\n",
                      "log.csv", told(""))
                .data.find(Role::motor_torque)
                ->values,
            (std::vector<double>{1.5, 2.5}));
  // Between blanks the words of a comment may be as many as the columns.
  expect_read("t_s q_rad dq_rad_s tau_Nm\n0 0.1 0 1\n0.002 0.2 0 2\n# end of log\n", told(""),
              {0.002, 0.2, 2});
  // Between commas such a line is a row: a mark of the recorder's in a column of its own.
  expect_read("mark,t_s,q_rad,tau_Nm\n-,0,0.1,1\n#,0.002,0.2,2\n", told("mark=none"),
              {0.002, 0.2, 2});
  // Below numbers it is a comment, as wide as it may be.
  expect_read("t_s,q_rad,tau_Nm\n0,0.1,1\n#0.001,9,9\n0.002,0.2,2\n# end, of, file\n", told(""),
              {0.002, 0.2, 2});
  // Separators with blanks to either side.
  expect_read("t_s , q_rad , tau_Nm\n0 , 0.1 , 1\n0.002 , 0.2 , 2\n", told(""), {0.002, 0.2, 2});
  // A monitor of the bus writes its counters so.
  expect_read("t_s,enc [counts],tau_Nm\n0,0x0A,1\n0.002,0x10,2\n", told("", {}, {16.0, {}}),
              {0.002, 2 * M_PI, 2});
}

TEST(VendorLogs, ACommaInANumberIsDecimalWhereTheFileShowsIt) {
  const auto first = [](std::string_view text) {
    return parse_csv(text, "data.csv").data.at("v").values[0];
  };
  EXPECT_EQ(first("v,y\n\"1,234\",\"0,5\"\n\"2,5\",1\n"), 1.234);
  EXPECT_EQ(first("v,y\n\"-0,234\",2.5\n\"0,5\",1\n"), -0.234);
  EXPECT_EQ(first("v;y\n1,234;2\n1,235;1\n"), 1.234);
  EXPECT_EQ(first("v\ty\n1,234\t2.5\n1,235\t1\n"), 1.234);
}

TEST(VendorLogs, ACommaThatMayPartThousandsIsRefused) {
  const auto refused = [](std::string_view text) {
    try {
      parse_csv(text, "data.csv").data.at("v");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  for (const std::string_view text :
       {"v,y\n\"1,234\",2\n\"1,235\",3\n", "v,y\n\"1,234\",2.5\n\"1,235\",3\n",
        "v,y,z\n\"1,234\",2.5,\"0,5\"\n\"1,235\",3,\"1,5\"\n"}) {
    EXPECT_THAT(refused(text), AllOf(HasSubstr("data.csv:2:v"), HasSubstr("'1,234'"),
                                     HasSubstr("without signs for thousands")));
  }
  EXPECT_THAT(refused("v,y\n950,2.5\n\"1,050\",3\n"),
              AllOf(HasSubstr("data.csv:3:v: '1,050'"), HasSubstr("without signs for thousands")));
}

TEST(VendorLogs, AListInACellIsRefusedWithTheColumnsToWrite) {
  const char* text = "stamp,position,effort\n0.1,\"[0.1, 0.2]\",\"[1, 2]\"\n";
  try {
    parse_csv(text, "data.csv").data.at("position");
    ADD_FAILURE() << "it was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("data.csv:2:position"), HasSubstr("'[0.1, 0.2]'"),
                                    HasSubstr("'position[0]', 'position[1]'")));
  }
}

TEST(VendorLogs, TimesInWords) {
  expect_read(
      "timestamp,q_rad,tau_Nm\n2024-05-14T09:12:33.500000Z,0.1,1\n2024-05-14T09:12:33.502Z,0.2,2\n",
      told(""), {0.002, 0.2, 2});
  expect_read("Clock;q [rad];tau [Nm]\n09:12:33.500;0.1;1\n09:12:33.502;0.2;2\n", told(""),
              {33153.502, 0.2, 2});
  expect_read("Time,q_rad,tau_Nm\n0 sec,0.1,1\n0.002 sec,0.2,2\n", told(""), {0.002, 0.2, 2});
  EXPECT_EQ(read_time_text("1970-01-02 00:00:01"), 86401);
  EXPECT_EQ(read_time_text("2024-02-29T12:00:00+02:00"), 1709200800);
  EXPECT_EQ(read_time_text("14.05.2024 09:12:33,25"), read_time_text("2024/05/14 09:12:33.25"));
  // Day and month cannot be told apart, nor need they be; a clock goes on after midnight.
  expect_read(
      "Time,q_rad,tau_Nm\n05/06/2024 11:59:59.999 PM,0.1,1\n05/07/2024 12:00:00.001 AM,0.2,2\n",
      told(""), {86400.001, 0.2, 2});
  expect_read("Time,q_rad,tau_Nm\n23:59:59.999,0.1,1\n00:00:00.001,0.2,2\n", told(""),
              {86400.001, 0.2, 2});
  EXPECT_EQ(read_clock_behind_date("5/14/2024 1:02:03 PM"), 13 * 3600 + 123);
  for (const char* none : {"", "05/06/2024", "05/06/2024 13:02:03 PM", "2024/05/06 01:02:03",
                           "05/06/2024 01:02:03 x"}) {
    EXPECT_FALSE(read_clock_behind_date(none)) << none;
  }
  for (const char* none : {"", "12", "0.5", "2024-02-30 00:00:00", "05/06/2024 01:02:03",
                           "25:00:00", "1:2:3", "12 rad", "2024-05-14", "09:12:33.5 x"}) {
    EXPECT_FALSE(read_time_text(none)) << none;
  }
  EXPECT_THAT(complaint_of_log("time,q_rad,tau_Nm\n09:12:33,0.1,1\n5,0.2,2\n", told("")),
              HasSubstr("log.csv:3:time"));
}

TEST(VendorLogs, RecordingsOneAfterTheOtherAndWordsAtTheEnd) {
  const DataFile file = parse_csv(
      "time_s,pos_deg,torque_Nm\n0,1,1\n0.002,2,2\ntime_s,pos_deg,torque_Nm\n0,3,3\n0.002,4,4\n"
      "Recording stopped by user\n\n",
      "log.csv", told(""));
  EXPECT_EQ(file.data.rows(), 4U);
  EXPECT_EQ(file.data.movement, (std::vector<int>{0, 0, 1, 1}));
  EXPECT_FALSE(file.has_movements);
  EXPECT_EQ(file.warnings.size(), 2U);
  // A row that is torn in the middle of a file is no closing text.
  EXPECT_THAT(complaint_of_log("time_s,pos_deg\n0,1\nstopped\n0.1,2\n", told("")),
              HasSubstr("log.csv:3"));
  EXPECT_THAT(complaint_of_log("time_s,pos_deg,i_A\n0,1,1\n0.1,2\n", told("")),
              HasSubstr("log.csv:3"));
}

TEST(VendorLogs, WhatIsNoTableOrCannotBeToldIsRefused) {
  EXPECT_THAT(complaint_of_log("{\"t\": 0.1, \"pos\": 2}\n{\"t\": 0.2, \"pos\": 2}\n", told("")),
              HasSubstr("log.csv:1: these are JSON objects"));
  EXPECT_THAT(complaint_of_log("time [ms],pos [mdeg]\n\"1.0\",\"19,607,5\"\n", told("")),
              HasSubstr("log.csv:2:pos [mdeg]: '19,607,5'"));
  const DataFile bare = parse_csv("t,pos,cur\n0,1,2\n0.002,3,4\n", "log.csv", told(""));
  EXPECT_EQ(roles_line(bare), "t=time[s],pos=position[?],cur=motor_current[?]");
  EXPECT_EQ(what_is_missing(bare).size(), 2U);
  // Slow stamps of unknown unit are asked for: seconds, or milliseconds of a fast recorder.
  const DataFile slow =
      parse_csv("timestamp,q_rad,i_A\n0,1,2\n1,3,4\n2,3,4\n", "log.csv", told(""));
  EXPECT_THAT(roles_line(slow), HasSubstr("timestamp=time[?]"));
  // Nanoseconds since the recorder was switched on are no milliseconds since 1970.
  const DataFile boot =
      parse_csv("stamp,q_rad,i_A\n2000000000000,1,2\n2000002000000,3,4\n", "log.csv", told(""));
  EXPECT_THAT(roles_line(boot), HasSubstr("stamp=time[?]"));
}

TEST(VendorLogs, AColumnAloneInItsUnitIsWhatTheUnitSays) {
  EXPECT_EQ(roles_line(parse_csv("t [s],tempo [rad/s],i [A]\n0,1,2\n1,2,3\n", "log.csv", told(""))),
            "\"t [s]\"=time[s],\"tempo [rad/s]\"=velocity[rad/s],\"i [A]\"=motor_current[A]");
  const DataFile file = parse_csv(
      "tick_ms,shoulder [deg],J_A [A],housing (degC),set_deg,phase_ms\n0,90,1,30,1,2\n"
      "2,91,2,31,1,2\n",
      "log.csv", told(""));
  EXPECT_EQ(roles_line(file),
            "tick_ms=time[ms],\"shoulder [deg]\"=position[deg],\"J_A [A]\"=motor_current[A],"
            "\"housing (degC)\"=temperature[degC]");
  EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("'shoulder [deg]' is taken for the "
                                                           "position: it is the only one in deg")));
  // Beside a velocity an angle may be anything that was travelled.
  EXPECT_EQ(roles_line(parse_csv("t,dq,travel_rad\n0,1,2\n", "log.csv", told(""))),
            "t=time[s],dq=velocity[rad/s]");
  // The motor's angle stays the motor's in the line to copy.
  const DataFile geared = parse_csv("t,mot shoulder [deg],i_A\n0,90,1\n", "log.csv", told(""));
  EXPECT_THAT(roles_line(geared), HasSubstr("\"mot shoulder [deg]\"=position[deg@motor]"));
  // Two of a kind are for the user to tell apart; one letter behind a line is no unit.
  const DataFile two =
      parse_csv("t,elbow [deg],wrist [deg],line_A\n0,1,2,3\n", "log.csv", told(""));
  EXPECT_EQ(roles_line(two), "t=time[s]");
}

TEST(VendorLogs, AColumnThatIsWrittenAgainCountsOnce) {
  // A scope that gives each channel the time.
  const std::string text =
      "Name;Axis.ActPos [deg];Name;Axis.ActTorque [Nm]\n0;90;0;1\n2;91;2;2\n4;92;4;3\n";
  const DataFile file = parse_csv(text, "log.csv", told("Name=time[ms]"));
  expect_sample(file, 1, {0.002, 91 * kDegree, 2});
  EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("'Name' stands in the file again")));
  // What stands still in both tells nothing of what they are.
  EXPECT_THAT(complaint_of_log("t;vel;vel\n0;0;0\n1;0;0\n2;0;0\n", told("")),
              HasSubstr("two columns are named"));
}

TEST(VendorLogs, AThermometerThatIsReadMoreRarelyGoesStraightBetweenItsReadings) {
  const DataFile file = parse_csv(
      "t,q,tau [Nm],temp [degC]\n0,1,1,\n1,2,1,20\n2,3,1,\n3,4,1,-\n4,5,1,\n5,6,1,28\n6,7,1,null\n",
      "log.csv", told(""));
  EXPECT_EQ(file.data.find(Role::temperature)->values,
            (std::vector<double>{20, 20, 22, 24, 26, 28, 28}));
  EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("a value in 2 of 7 rows")));
  // A few that are missing are as anywhere.
  EXPECT_THAT(complaint_of_log("t,q,temp [degC]\n0,1,20\n1,2,-\n2,2,21\n", told("")),
              HasSubstr("'-' is not"));
}

TEST(VendorLogs, JointsThatTakeTurnsRowByRowAreToldApartByWhere) {
  std::string text = "time_s,joint_name,pos_deg,tau_Nm\n";
  for (int i = 0; i < 12; ++i) {
    text += fmt::format("{}.0,shoulder,{},1\n{}.1,elbow,{},2\n", i, 10 + i, i, 50 - i);
  }
  const DataFile file = parse_csv(text, "log.csv", told(""));
  EXPECT_THAT(what_is_missing(file),
              ::testing::Contains(HasSubstr("stand in turn (joint_name = shoulder, elbow): choose "
                                            "one with --where 'joint_name=shoulder'")));
  const ScratchFolder folder;
  const std::vector<std::filesystem::path> files = {folder.path() / "log.csv"};
  std::ofstream(files[0]) << text;
  DataOptions options;
  options.where = "joint_name=elbow";
  const DataFile elbow = read_data(files, options, std::vector<std::string>{});
  EXPECT_THAT(what_is_missing(elbow), ::testing::IsEmpty());
  EXPECT_EQ(elbow.data.rows(), 12U);
  EXPECT_NEAR(elbow.data.find(Role::position)->values[1], 49 * kDegree, 1e-12);
}

TEST(VendorLogs, ColumnsWithoutNamesAreNumbered) {
  const std::string roles = "column_1=time[ms],column_2=position[deg],column_4=motor_torque[N m]";
  for (const char* text : {"0 90 5 1\n2 91 5 2\n", "# t q x tau\n0;90;5;1;\n2;91;5;2;\n",
                           "0\t90\t5\t1\n2\t91\t5\t2\n"}) {
    expect_read(text, told(roles), {0.002, 91 * kDegree, 2});
  }
  EXPECT_THAT(complaint_of_log("0 90 5 1\n2 91 5 2\n", told("")), HasSubstr("'column_1=time[s]"));
  EXPECT_THAT(complaint_of_log("0 90 5\n2 91\n3 1 2\n", told(roles)),
              HasSubstr("column 'column_4'"));
}

TEST(VendorLogs, ADateThatHoldsTheClockIsTheTime) {
  const std::string text =
      "Date,q_deg,tau_Nm\n2025-03-07T14:58:21.25,90,1\n2025-03-07T14:58:21.27,91,2\n";
  expect_sample(parse_csv(text, "log.csv", told("")), 1, {0.02, 91 * kDegree, 2});
  const DataFile two =
      parse_csv("Date,Time,q_deg\n2025-03-07,14:58:21.25,90\n", "log.csv", told(""));
  EXPECT_EQ(roles_line(two), "Time=time[s],q_deg=position[deg]");
}

TEST(VendorLogs, NamesThatSayNothingAreListedWithTheMend) {
  EXPECT_THAT(complaint_of_log("c1,c2\n0,1\n", told("")),
              ::testing::AllOf(HasSubstr("no column's name is known: c1, c2"),
                               HasSubstr("--roles 'c1=time[s]")));
  EXPECT_THAT(complaint_of_log("0.1 2\n0.2 3\n", told("c1=time")),
              HasSubstr("holds numbers, not names"));
}

}  // namespace
}  // namespace tribench
