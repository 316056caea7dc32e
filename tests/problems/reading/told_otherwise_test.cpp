// SPDX-License-Identifier: MIT
//
// One recording as other recorders, countries and people write it: it is read as the same, or
// refused with a mend that mends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "foundation/error.hpp"
#include "problems/reading/csv.hpp"
#include "problems/reading/explanation.hpp"
#include "problems/reading/time_text.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

CsvOptions of_loop(const std::string& roles = "") {
  CsvOptions options;
  options.roles = parse_roles(roles, "--roles");
  options.used.emplace();
  return options;
}

std::string what_is_wrong(const std::string& text, const CsvOptions& options = of_loop()) {
  try {
    const DataFile file = parse_csv(text, "log.csv", options);
    check_complete(file);
  } catch (const Error& error) {
    return error.what();
  }
  return "read";
}

// The second row's time of a recording whose stamps these are.
double second_time(const std::string& first, const std::string& second,
                   const std::string& name = "Time", const std::string& roles = "") {
  const DataFile file =
      parse_csv(name + ",q_rad,tau_Nm\n" + first + ",0.1,1\n" + second + ",0.2,2\n", "log.csv",
                of_loop(roles));
  const Channel* time = file.data.find(Role::time);
  return time == nullptr ? std::nan("") : time->values[1];
}

TEST(ToldOtherwise, TimesInWords) {
  EXPECT_NEAR(second_time("12:33.000", "12:33.002"), 753.002, 1e-9);
  EXPECT_NEAR(second_time("09:12:33:000", "09:12:33:002"), 33153.002, 1e-9);
  EXPECT_NEAR(second_time("0 days 00:00:00.01", "0 days 00:00:00.012"), 0.012, 1e-9);
  EXPECT_EQ(read_time_text("1 day 00:00:01"), 86401);
  const std::optional<double> same = read_time_text("2024-05-14T09:12:33.25Z");
  for (const char* text :
       {"14-May-2024 09:12:33.25", "May 14 2024 09:12:33.25", "May 14, 2024, 09:12:33.25",
        "14 may 2024 09:12:33.25", "14. Mai 2024 09:12:33,25", "20240514T091233.25Z",
        "20240514T091233.25", "20240514_091233.25", "2024-05-14 09:12:33.25 UTC",
        "2024-05-14T14:42:33.25+0530", "2024-05-14 09:12:33.25 GMT", "2024-05-14T11:12:33.25+02",
        "14-May-2024 9:12:33.25 AM"}) {
    EXPECT_EQ(read_time_text(text), same) << text;
  }
  // Hours and minutes, or minutes and seconds; a number; no date.
  for (const char* none : {"12:33", "12:61.0", "20240514", "20241314T091233",
                           "31-Feb-2024 09:12:33", "14-Foo-2024 09:12:33", "days 00:00:01",
                           "2024-05-14T09:12:33+5", "09:12:33:25", "May 2024 09:12:33"}) {
    EXPECT_FALSE(read_time_text(none)) << none;
  }
}

TEST(ToldOtherwise, TimesInDaysAndHours) {
  EXPECT_NEAR(second_time("0", "0.0000000115741", "time [d]"), 0.001, 1e-8);
  EXPECT_NEAR(second_time("0", "0.0000000115741", "time [days]"), 0.001, 1e-8);
  EXPECT_NEAR(second_time("0", "0.00000027778", "time [h]"), 0.001, 1e-7);
  EXPECT_NEAR(second_time("0", "0.00000027778", "time [hours]"), 0.001, 1e-7);
  EXPECT_NEAR(second_time("0", "0.0000166667", "time [min]"), 0.001, 1e-8);
  EXPECT_NEAR(second_time("0", "0.5", "stamp", "stamp=time[day]"), 43200, 1e-8);
}

TEST(ToldOtherwise, TimesSinceAYear) {
  // A spreadsheet's days, MATLAB's datenum, Windows' and .NET's counts of 100 ns.
  EXPECT_NEAR(second_time("45426.500000000000", "45426.500000011576"), 0.001, 1e-6);
  EXPECT_NEAR(second_time("45426.500000000000", "45426.500000011576", "Date"), 0.001, 1e-6);
  EXPECT_NEAR(second_time("45426.5", "45426.500005787", "Time", "Time=time[d]"), 0.5, 1e-4);
  EXPECT_NEAR(second_time("739386.500000000", "739386.500000012", "timestamp"), 0.001, 5e-5);
  EXPECT_NEAR(second_time("133600000000000000", "133600000000010000", "timestamp"), 0.001, 1e-5);
  EXPECT_NEAR(second_time("638500000000000000", "638500000000010000", "timestamp"), 0.001, 1e-5);
  // Seconds of a long run, steps of seconds or a date alone are none.
  EXPECT_NEAR(second_time("45426.5", "45426.501"), 45426.501, 1e-9);
  EXPECT_TRUE(std::isnan(second_time("45426", "45426", "Date")));
  EXPECT_THAT(what_is_wrong("t,q_rad,tau_Nm\n133600000000000000,1,1\n133600000000010000,2,2\n",
                            of_loop("t=time[ms]")),
              HasSubstr("100 ns since 1601: --roles 't=time[100 ns]'"));
}

TEST(ToldOtherwise, AMendMends) {
  const std::string rows = ",0.1,1\n";
  EXPECT_THAT(what_is_wrong("Time,q_rad,tau_Nm\n12:33" + rows + "12:34" + rows),
              AllOf(HasSubstr("log.csv:2:Time: '12:33'"), HasSubstr("times that are read: 2024-05"),
                    Not(HasSubstr("--drop-missing"))));
  CsvOptions drops = of_loop();
  drops.drop_missing = true;
  const std::string names = "t,q_rad,tau_Nm\n0,1,1\n";
  EXPECT_THAT(what_is_wrong(names + "1,2,11'622.300\n2,3,11 622.3\n"),
              AllOf(HasSubstr("log.csv:3"), HasSubstr("signs for thousands")));
  EXPECT_THAT(what_is_wrong(names + "1,2,\"11,622\"\n"), HasSubstr("signs for thousands"));
  EXPECT_THAT(what_is_wrong(names + "1,2,11.6 Nm\n"), HasSubstr("the column's name says the unit"));
  EXPECT_THAT(what_is_wrong("t,q_rad,tau\n0,1,11.6 Nm\n"), HasSubstr("'tau [Nm]'"));
  EXPECT_THAT(what_is_wrong(names + "1,2,x\n"),
              HasSubstr("leave the cell empty and drop such rows with --drop-missing"));
  EXPECT_THAT(what_is_wrong(names + "1,2,x\n", drops),
              AllOf(HasSubstr("leave the cell empty"), Not(HasSubstr("--drop-missing"))));
  EXPECT_THAT(
      what_is_wrong("t,q_rad,tau_Nm\n0,1,x\n1,2,y\n"),
      AllOf(HasSubstr("no value of the column can be read"), Not(HasSubstr("--drop-missing"))));
}

TEST(ToldOtherwise, NumbersAsTheyArePrinted) {
  CsvOptions drops = of_loop();
  drops.drop_missing = true;
  const DataFile file = parse_csv(
      "t,q_rad,tau_Nm\n0,\xE2\x88\x92"
      "1.5,1\n1,2,1e\xE2\x88\x92"
      "1\n2,3,-1.#IND\n3,4,1.#QNAN\n"
      "4,5,1.#INF00\n5,6,7\n",
      "log.csv", drops);
  EXPECT_EQ(file.dropped_rows, 3U);
  EXPECT_EQ(file.data.find(Role::position)->values, (std::vector<double>{-1.5, 2, 6}));
  EXPECT_EQ(file.data.find(Role::motor_torque)->values, (std::vector<double>{1, 0.1, 7}));
}

TEST(ToldOtherwise, WhatNothingReadsMayHaveGaps) {
  const DataFile file =
      parse_csv("t,q_rad,motor_current_A,motor_torque_Nm\n0,1,NaN,1\n1,2,1,2\n2,3,,3\n", "log.csv",
                of_loop());
  EXPECT_EQ(file.data.rows(), 3U);
  EXPECT_EQ(file.data.find(Role::motor_current), nullptr);
  EXPECT_THAT(file.warnings,
              ::testing::Contains(HasSubstr("'motor_current_A' is read without a role")));
}

std::string what_is_wrong_with_bytes(const std::string& name, const std::string& bytes) {
  const std::filesystem::path folder = testing::scratch_folder() / "foreign";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << bytes;
  try {
    read_csv(folder / name, of_loop());
  } catch (const Error& error) {
    return error.what();
  }
  return "read";
}

TEST(ToldOtherwise, WhatIsNoTextIsSaidToBeWhatItIs) {
  const std::string zero(30, '\0');
  const std::string zip = "PK\x03\x04" + zero.substr(4);
  EXPECT_THAT(what_is_wrong_with_bytes("a.zip", zip + "log.csv"),
              AllOf(HasSubstr("zip archive"), HasSubstr("unzip '")));
  EXPECT_THAT(
      what_is_wrong_with_bytes("a.xlsx", zip + "[Content_Types].xml" + zero + "xl/workbook.xml"),
      AllOf(HasSubstr("workbook"), HasSubstr("as CSV")));
  EXPECT_THAT(what_is_wrong_with_bytes("a.npz", zip + "t.npy"), HasSubstr("numpy.load"));
  EXPECT_THAT(what_is_wrong_with_bytes("a.bz2", "BZh91AY" + zero), HasSubstr("bunzip2 -k '"));
  EXPECT_THAT(what_is_wrong_with_bytes("a.mat", "MATLAB 5.0 MAT-file, " + zero),
              HasSubstr("MATLAB"));
  EXPECT_THAT(what_is_wrong_with_bytes("a.db3", "SQLite format 3" + zero),
              HasSubstr("adapters/ros_to_csv.py"));
  EXPECT_THAT(what_is_wrong_with_bytes("a.json", "[{\"q\": 1}]"),
              AllOf(HasSubstr("a.json:1: this is a JSON array"), HasSubstr("read_json")));
  EXPECT_THAT(what_is_wrong_with_bytes("a.html", "<table><tr>"), HasSubstr("read_html"));
  EXPECT_EQ(what_is_wrong_with_bytes("b.csv", "PAR1,tau_Nm\n1,2\n"), "read");
}

TEST(ToldOtherwise, AFolderIsNamedByItsFiles) {
  const std::filesystem::path folder = testing::scratch_folder() / "runs";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.csv") << "q\n1\n";
  try {
    read_csv(folder, of_loop());
    ADD_FAILURE() << "it was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("runs/*.csv"));
  }
}

// The roles of the columns but those without one: "time position ...".
std::string roles_of(const std::string& header) {
  const auto columns = std::ranges::count(header, ';');
  std::string text = header + "\n";
  for (int row = 0; row < 2; ++row) {
    for (auto j = columns; j >= 0; --j) text += std::to_string(row) + (j > 0 ? ";" : "\n");
  }
  std::string roles;
  for (const ColumnReading& reading : parse_csv(text, "log.csv", of_loop()).readings) {
    if (reading.role == Role::none) continue;
    roles += (roles.empty() ? "" : " ") + std::string(role_name(reading.role));
  }
  return roles;
}

TEST(ToldOtherwise, NamesInOtherLanguages) {
  constexpr const char* kAll = "time position velocity motor_torque gravity_torque temperature";
  for (const char* header :
       {"Temps (s);Position (rad);Vitesse (rad/s);Courant (A);Couple moteur (N.m);Couple de "
        "gravit\xC3\xA9 (N.m);Temp\xC3\xA9rature (\xC2\xB0"
        "C)",
        "Tiempo (s);Posici\xC3\xB3n (rad);Velocidad (rad/s);Corriente (A);Par motor (Nm);Par de "
        "gravedad (Nm);Temperatura (\xC2\xB0"
        "C)",
        "Tempo [s];Posizione [rad];Velocit\xC3\xA0 [rad/s];Corrente [A];Coppia motore [Nm];Coppia "
        "di "
        "gravit\xC3\xA0 [Nm];Temperatura [\xC2\xB0"
        "C]",
        "Tempo (s);Posi\xC3\xA7\xC3\xA3o (rad);Velocidade (rad/s);Corrente (A);Torque do motor "
        "(Nm);Torque gravitacional (Nm);Temperatura (\xC2\xBA"
        "C)",
        "Tijd [s];Positie [rad];Snelheid [rad/s];Stroom [A];Koppel [Nm];Zwaartekrachtkoppel "
        "[Nm];Temperatuur [C]",
        "Czas [s];Pozycja [rad];Pr\xC4\x99"
        "dko\xC5\x9B\xC4\x87 [rad/s];Moment [Nm];Moment grawitacji "
        "[Nm];Temperatura [C]",
        "Zeit in s;Winkel in Grad;Winkelgeschwindigkeit in Grad/s;Motorstrom in A;Antriebsmoment "
        "in "
        "Nm;Gravitationsmoment in Nm;Temperatur in \xC2\xB0"
        "C",
        "Zeit (s);Gelenkwinkel (\xC2\xB0);Drehgeschwindigkeit (\xC2\xB0/s);Motormoment (Nm);"
        "Schweremoment (Nm);Motortemperatur (C)",
        "elapsed time [s];joint angle [rad];rate [rad/s];measured torque [Nm];gravity compensation "
        "torque [Nm];temperature [C]",
        "t [s];\xCE\xB8 [rad];\xCF\x89 [rad/s];\xCF\x84 [Nm];\xCF\x84_g [Nm];T [\xC2\xB0"
        "C]",
        "$t$ [s];$q$ [rad];$\\dot{q}$ [rad/s];$\\tau$ [Nm];$\\tau_g$ [Nm];$T$ [$^\\circ$C]",
        "time;out.q.Data;out.dq.Data;out.tau.Data;out.tau_g.Data;out.T.Data"}) {
    EXPECT_EQ(roles_of(header), kAll) << header;
  }
  // What means several things is what its unit says, or nothing.
  EXPECT_EQ(roles_of("t [s];rate [Hz];par;couple;tempo [rad/s];q [rad];tau [Nm]"),
            "time velocity position motor_torque");
  EXPECT_EQ(roles_of("t [degC];time [s];q [rad];tau [Nm]"),
            "temperature time position motor_torque");
}

TEST(ToldOtherwise, LabviewsHeader) {
  const DataFile file = parse_csv(
      "LabVIEW Measurement\t\nSeparator\tTab\nDate\t2024/05/14\n***End_of_Header***\t\n\t\n"
      "Channels\t2\t\t\nSamples\t3\t3\nY_Unit_Label\tdeg\tmN m\nX0\t0.0E+0\t0.0E+0\n"
      "Delta_X\t0.001\t0.001\n***End_of_Header***\t\t\nX_Value\tposition\tmotor_torque\tComment\r\n"
      "0\t0\t1\t\r\n0.001\t90\t2\t\r\n0.002\t180\t3\t\r\n",
      "log.lvm", of_loop());
  EXPECT_EQ(file.data.rows(), 3U);
  EXPECT_EQ(file.data.find(Role::time)->values[1], 0.001);
  EXPECT_NEAR(file.data.find(Role::position)->values[1], M_PI / 2, 1e-12);
  EXPECT_NEAR(file.data.find(Role::motor_torque)->values[1], 2e-3, 1e-12);
  EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("11 lines before the columns' names")));
}

TEST(ToldOtherwise, TwincatsLabels) {
  std::string text =
      "Name;YT "
      "Chart\nFile;C:\\a.svdx\n\nName;Position;Name;MotorTorque\nSymbolComment;;SymbolComment;\n"
      "Data-Type;REAL64;Data-Type;REAL64\nUnit;deg;Unit;Nm\nSampleTime[ms];1;SampleTime[ms];1\n\n";
  const DataFile file = parse_csv(text + "0;0;0;1\n1;90;1;2\n2;180;2;3\n", "log.csv", of_loop());
  EXPECT_EQ(file.data.rows(), 3U);
  EXPECT_EQ(file.data.find(Role::time)->values[1], 0.001);
  EXPECT_NEAR(file.data.find(Role::position)->values[1], M_PI / 2, 1e-12);
  EXPECT_EQ(file.data.find(Role::motor_torque)->values[1], 2);
}

TEST(ToldOtherwise, ABlockBeforeRowsWithoutNames) {
  EXPECT_THAT(what_is_wrong("Recorder 7\nserial;4711\nby;lab\n0;1;2\n1;2;3\n2;3;4\n3;4;5\n"),
              AllOf(HasSubstr("begins with a block of 3 lines"), HasSubstr("tail -n +4 FILE")));
}

TEST(ToldOtherwise, UnitsInsideOfNames) {
  const auto unit_of_position = [](const std::string& name) {
    const DataFile file = parse_csv("t;" + name + ";tau_Nm\n0;1;1\n1;2;1\n", "log.csv", of_loop());
    return file.readings[1].role == Role::position ? file.readings[1].unit : "none";
  };
  EXPECT_EQ(unit_of_position("position in deg"), "deg");
  EXPECT_EQ(unit_of_position("angle_in_degrees"), "deg");
  EXPECT_EQ(unit_of_position("deg_position"), "deg");
  EXPECT_EQ(unit_of_position("$AXIS_ACT[4]"), "deg");
  EXPECT_EQ(unit_of_position("AXIS_ACT_A4"), "deg");
  EXPECT_EQ(unit_of_position("position [in]"), "in");
  EXPECT_EQ(unit_of_position("rad_angle"), "rad");
  for (const char* other :
       {"position_in", "turn_angle", "joint_rotation", "min_position", "pos_u"}) {
    EXPECT_EQ(unit_of_position(other), "none") << other;
  }
  EXPECT_EQ(roles_of("start_hour;q_rad;tau_Nm"), "position motor_torque");
}

TEST(ToldOtherwise, UnitsAsPeopleWriteThem) {
  struct Case {
    const char* unit;
    double factor;
  };
  for (const auto& [unit, factor] :
       {Case{"cNm", 0.01}, Case{"kgm", 9.80665}, Case{"kgf\xC2\xB7m", 9.80665},
        Case{"ft-lbs", 1.3558179483314004}, Case{"in-lbs", 0.1129848290276167},
        Case{"lbf", 4.4482216152605}, Case{"Newton metres", 1}, Case{"\xE2\x80\xB0", 0.1}}) {
    const DataFile file = parse_csv(
        std::string("t;q_rad;motor torque [") + unit + "]\n0;1;1\n1;2;1\n", "log.csv", of_loop());
    EXPECT_NEAR(file.data.find(Role::motor_torque)->values[1], factor, 1e-12) << unit;
    EXPECT_NE(file.data.find(Role::motor_torque)->unit, "-") << unit;
  }
  for (const auto& [unit, factor] :
       {Case{"in", 0.0254}, Case{"gon", M_PI / 200}, Case{"arcmin", M_PI / 10800},
        Case{"tr", 2 * M_PI}, Case{"U", 2 * M_PI}, Case{"rotations", 2 * M_PI},
        Case{"\xC2\xB5rad", 1e-6}, Case{"urad", 1e-6}, Case{"\xC2\xBA", M_PI / 180}}) {
    const DataFile file = parse_csv(std::string("t;position [") + unit + "];tau_Nm\n0;0;1\n1;1;1\n",
                                    "log.csv", of_loop());
    EXPECT_NEAR(file.data.find(Role::position)->values[1], factor, 1e-12) << unit;
  }
  EXPECT_THAT(what_is_wrong("t;position [degs];tau_Nm\n0;0;1\n1;1;1\n"),
              AllOf(HasSubstr("column 'position [degs]': 'degs' is no unit of a position (is deg "
                              "meant?)")));
}

TEST(ToldOtherwise, ATorqueInAnUnknownUnitIsNotHeldAgainstAnother) {
  EXPECT_THAT(what_is_wrong("t;q_rad;torque [smoots];gravity_torque [Nm]\n0;0;1;1\n1;1;1;1\n"),
              AllOf(HasSubstr("column 'torque [smoots]': 'smoots' is no unit of a motor_torque"),
                    HasSubstr("'gravity_torque [Nm]' is in N m"),
                    HasSubstr("--roles 'torque [smoots]=motor_torque[UNIT]'")));
}

TEST(ToldOtherwise, AUnitThatIsNotKnownIsNamed) {
  const DataFile file = parse_csv("t,q_rad,torque [smoots]\n0,1,2\n1,2,3\n", "log.csv", of_loop());
  EXPECT_THAT(what_was_converted(file),
              ::testing::Contains(
                  "'torque [smoots]' is the motor_torque: 'smoots' is no unit that is known: read "
                  "as it stands"));
}

}  // namespace
}  // namespace tribench
