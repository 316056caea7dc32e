// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "tests/harness/cli/loop_runs.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using testing::families;
using testing::generated;
using ::testing::HasSubstr;
using testing::run_tribench;
using Json = nlohmann::json;

// `rows` rows a movement, friction Coulomb and viscous with a ripple that no model has; the line
// maker turns (movement, row) into a line.
template <typename Line>
std::string file_of(const testing::TemporaryFolder& folder, const std::string& header,
                    int movements, int rows, Line line) {
  std::string text = header + "\n";
  for (int m = 0; m < movements; ++m) {
    for (int i = 0; i < rows; ++i) text += line(m, i) + "\n";
  }
  testing::write_text(folder / "bad.csv", text);
  return (folder / "bad.csv").string();
}

double speed_of(int m) { return (m % 2 == 0 ? 1 : -1) * (0.1 + 0.05 * m); }
double noise_of(int m, int i) {
  RandomStream random = RandomStream(7).split(static_cast<std::uint64_t>(1000 * m + i));
  return 0.3 * random.normal();
}
double friction_of(double v, int m, int i) { return (v > 0 ? 5 : -5) + 3 * v + noise_of(m, i); }

std::string csv(std::initializer_list<double> values) {
  std::string text;
  for (const double x : values) text += (text.empty() ? "" : ",") + std::to_string(x);
  return text;
}

constexpr const char* kPlainHeader = "movement,velocity_rad_s,friction_torque_Nm";

std::string plain_line(int m, int i) {
  return csv({1.0 * m, speed_of(m), friction_of(speed_of(m), m, i)});
}

// What it says of such a file and these options, having ended with status 2.
template <typename Line>
std::string complaint(const std::string& header, Line line,
                      const std::vector<std::string>& more = {}) {
  const testing::TemporaryFolder folder;
  std::vector<std::string> arguments = {"loop", file_of(folder, header, 12, 20, line)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const testing::ProgramRun run = run_tribench(arguments);
  EXPECT_EQ(run.status, 2) << header;
  return run.errors;
}

TEST(LoopCommand, BadDataEndWithStatus2AndItSaysHowToMendThem) {
  EXPECT_THAT(complaint("movement,speed,friction_torque_Nm", plain_line), HasSubstr("--roles"));
  EXPECT_THAT(complaint("movement,velocity_rad_s,load_cell", plain_line), HasSubstr("--roles"));
  EXPECT_THAT(complaint(kPlainHeader,
                        [](int m, int i) {
                          return csv({1.0 * m, speed_of(m), -friction_of(speed_of(m), m, i)});
                        }),
              HasSubstr("--flip-sign"));
  EXPECT_THAT(complaint(kPlainHeader,
                        [](int m, int i) {
                          return std::to_string(m) + "," + std::to_string(speed_of(m)) + "," +
                                 (i == 3 ? "nan" : std::to_string(friction_of(speed_of(m), m, i)));
                        }),
              HasSubstr("--drop-missing"));
  EXPECT_THAT(complaint(kPlainHeader,
                        [](int m, int) {
                          return std::to_string(m) + "," + std::to_string(speed_of(m)) + ",inf";
                        }),
              HasSubstr("friction_torque_Nm"));
  for (const double dead : {0.0, 5.0}) {
    EXPECT_THAT(
        complaint(kPlainHeader,
                  [&](int m, int) {
                    return csv({1.0 * m, speed_of(m), dead});
                  }),
        AllOf(HasSubstr("friction_torque_Nm"), HasSubstr("in every row"), HasSubstr("--roles")));
  }
}

TEST(LoopCommand, BadOptionsEndWithStatus2AndItSaysHowToMendThem) {
  const testing::TemporaryFolder folder;
  const auto option_complaint = [](const std::vector<std::string>& more) {
    return complaint(kPlainHeader, plain_line, more);
  };
  EXPECT_THAT(option_complaint({"--min-speed", "99"}), HasSubstr("--min-speed"));
  EXPECT_THAT(option_complaint({"--effects", "stribek"}), HasSubstr("stribeck"));
  EXPECT_THAT(option_complaint({"--model", "symetric"}), HasSubstr("symmetric"));
  EXPECT_THAT(option_complaint({"--model", "5*w +"}), HasSubstr("w"));
  EXPECT_THAT(option_complaint({"--where", "nope=1"}), HasSubstr("nope"));
  EXPECT_THAT(option_complaint({"--where", "velocity_rad_s=1xyz"}), HasSubstr("1xyz"));
  EXPECT_THAT(option_complaint({"--leave-out", "velocity"}), HasSubstr("velocity_rad_s"));
  EXPECT_THAT(option_complaint({"--leave-out", "friction_torque_Nm"}),
              HasSubstr("changes within a movement"));
  EXPECT_THAT(option_complaint({"--save-effect", (folder / "effect.toml").string()}),
              HasSubstr("--learn"));
  EXPECT_THAT(option_complaint({"--learn", "pysir"}), HasSubstr("pysr"));
  // Nothing could ever be found.
  EXPECT_THAT(option_complaint({"--flips", "498"}),
              AllOf(HasSubstr("498 sign flips"), HasSubstr("take 499 or more")));
  EXPECT_THAT(option_complaint({"--alpha", "1e-5"}), HasSubstr("take 99999 or more"));
}

TEST(LoopCommand, AFolderThatCannotBeMadeIsSaidBeforeTheWork) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "taken", "a file");
  const std::string file =
      file_of(folder, "movement,velocity_rad_s,friction_torque_Nm", 12, 20, [](int m, int i) {
        return csv({1.0 * m, speed_of(m), friction_of(speed_of(m), m, i)});
      });
  const testing::ProgramRun run =
      run_tribench({"loop", file, "--out", (folder / "taken" / "below").string()});
  EXPECT_NE(run.status, 0);
  EXPECT_THAT(run.errors, HasSubstr("taken"));
  EXPECT_EQ(run.output, "");  // no verdict that would then be lost
}

TEST(LoopCommand, PoorInputIsWarnedOfAndNothingIsClaimed) {
  const testing::TemporaryFolder folder;
  const auto answer = [&](const std::string& header, int movements, int rows, auto line) {
    const testing::ProgramRun run =
        run_tribench({"loop", file_of(folder, header, movements, rows, line), "--json"});
    // Fewer stretches than any test needs.
    EXPECT_EQ(run.status, 4) << run.errors;
    const Json loop = Json::parse(run.output);
    EXPECT_EQ(loop["verdict"], "CANNOT_TELL") << header;
    EXPECT_THAT(loop["needed"].dump(), HasSubstr("20 stretches"));
    EXPECT_TRUE(loop["effects"].empty()) << header;
    return loop["warnings"].dump() + loop["notes"].dump();
  };
  // No movement column: the file is one movement.
  EXPECT_THAT(answer("velocity_rad_s,friction_torque_Nm", 1, 400,
                     [](int m, int i) {
                       const double v = std::sin(0.05 * i);
                       return csv({v, friction_of(v, m, i)});
                     }),
              HasSubstr("one movement"));
  // A channel that never changes.
  EXPECT_THAT(answer("movement,velocity_rad_s,temperature_degC,friction_torque_Nm", 12, 20,
                     [](int m, int i) {
                       return csv({1.0 * m, speed_of(m), 30, friction_of(speed_of(m), m, i)});
                     }),
              HasSubstr("constant"));
  // Too few movements.
  EXPECT_THAT(answer("movement,velocity_rad_s,friction_torque_Nm", 4, 40,
                     [](int m, int i) {
                       return csv({1.0 * m, speed_of(m), friction_of(speed_of(m), m, i)});
                     }),
              HasSubstr("there are 4 movements"));
  // All one direction.
  EXPECT_THAT(answer("movement,velocity_rad_s,friction_torque_Nm", 12, 20,
                     [](int m, int i) {
                       const double v = std::abs(speed_of(m));
                       return csv({1.0 * m, v, friction_of(v, m, i)});
                     }),
              HasSubstr("one direction"));
}

// Sines of a joint with inertia 1.5, Coulomb friction and an offset by direction, positions in
// degrees: half a second ahead either model keeps to the motion, and says so in degrees.
TEST(LoopCommand, SaysWhatTheModelsAreWorthInMotionWhereTheInertiaIsKnown) {
  const testing::TemporaryFolder folder;
  const auto line = [](int m, int i) {
    const double t = 0.005 * i;
    const double rate = 1.5 + 0.2 * m;
    const double size = 0.6 / rate;
    const double q = -size * std::cos(rate * t);
    const double v = size * rate * std::sin(rate * t);
    const double a = size * rate * rate * std::cos(rate * t);
    const double tau = 1.5 * a + 3 * v + (v > 0 ? 5 : v < 0 ? -5 : 0) + 0.1 * noise_of(m, i);
    return std::to_string(m) + "," + csv({t, 57.29577951 * q, v, a, tau});
  };
  const std::string file =
      file_of(folder, "movement,time_s,pos_deg,vel_rad_s,acc_rad_s2,tau_Nm", 12, 200, line);
  const testing::ProgramRun run =
      run_tribench({"loop", file, "--gravity", "none", "--roles",
                    "pos_deg=position[deg],vel_rad_s=velocity,acc_rad_s2=acceleration,"
                    "tau_Nm=motor_torque[N m]",
                    "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json loop = Json::parse(run.output);
  ASSERT_TRUE(loop.contains("motion")) << run.output.substr(0, 2000);
  EXPECT_EQ(loop["motion"]["unit"], "deg");
  EXPECT_EQ(loop["motion"]["horizon_s"], 0.5);
  EXPECT_GT(loop["motion"]["after"].get<double>(), 0);
  EXPECT_LT(loop["motion"]["after"].get<double>(), 0.3);
  EXPECT_LT(loop["motion"]["before"].get<double>(), 0.3);
}

TEST(LoopCommand, FilesWithoutMovementsAreOneMovementEach) {
  const testing::TemporaryFolder folder;
  std::vector<std::string> command = {"loop"};
  for (int m = 0; m < 12; ++m) {
    std::string text = "velocity_rad_s,friction_torque_Nm\n";
    for (int i = 0; i < 30; ++i) {
      text += csv({speed_of(m), friction_of(speed_of(m), m, i)}) + "\n";
    }
    const std::string name = "pass" + std::to_string(m) + ".csv";
    testing::write_text(folder / name, text);
    command.push_back((folder / name).string());
  }
  command.push_back("--json");
  const testing::ProgramRun run = run_tribench(command);
  ASSERT_EQ(run.status, 4) << run.errors;  // twelve stretches are too few to tell
  const Json loop = Json::parse(run.output);
  EXPECT_EQ(loop["verdict"], "CANNOT_TELL");
  EXPECT_EQ(loop["noise"]["movements"], 12);
  EXPECT_THAT(loop["notes"].dump(), HasSubstr("12 movements"));
}

// Strokes that start at once: the acceleration of a position alone does not follow.
TEST(LoopCommand, WhereItFindsNothingItSaysInWhichRowsItDidNotLook) {
  const testing::TemporaryFolder folder;
  constexpr double kStep = 0.004;
  constexpr int kRows = 600;
  double position = 0;
  const std::string file =
      file_of(folder, "time_s,position_rad,motor_torque_Nm", 24, kRows, [&](int m, int i) {
        const bool rests = i < 100;
        const double v = rests ? 0 : (m % 2 == 0 ? 0.8 : -0.8) * (0.3 + 0.03 * m);
        position += kStep * v;
        const double torque = rests ? noise_of(m, i) : friction_of(v, m, i);
        return csv({kStep * (kRows * m + i), std::round(position * 1e4) / 1e4, torque});
      });
  const std::string out = (folder / "out").string();
  const testing::ProgramRun run = run_tribench({"loop", file, "--gravity", "none", "--out", out});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("Not looked at: in "));
  const Json steps = Json::parse(testing::read_text(out + "/loop.json"))["data_steps"];
  const std::size_t moving = steps[1]["rows"];
  const std::size_t left = steps[2]["rows"];
  EXPECT_LT(left, moving);
  EXPECT_THAT(steps[2]["not_looked_at"].get<std::string>(),
              HasSubstr("in " + std::to_string(moving - left) + " of "));
}

// Data that leave nothing to be found, or nothing to find it with.
TEST(LoopCommand, AColumnThatNobodyUsesMayHoldAnything) {
  const testing::TemporaryFolder folder;
  const auto answer = [&](const std::string& header, auto line,
                          const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"loop", file_of(folder, header, 12, 20, line), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return Json::parse(run_tribench(words).output)["error"];
  };
  // A name that tells, taken away by hand.
  EXPECT_EQ(answer(std::string(kPlainHeader) + ",temperature",
                   [](int m, int i) { return plain_line(m, i) + (i % 2 == 0 ? ",1e300" : ",-7"); },
                   {"--roles", "temperature=none"}),
            answer(kPlainHeader, plain_line));
  EXPECT_EQ(answer(std::string(kPlainHeader) + ",junk",
                   [](int m, int i) { return plain_line(m, i) + (i % 2 == 0 ? ",1e300" : ",-7"); }),
            answer(kPlainHeader, plain_line));
}

TEST(LoopCommand, DegenerateDataNeitherCrashNorClaimAnything) {
  const testing::TemporaryFolder folder;
  const auto expect_nothing = [&](const std::string& header, const char* verdict, int status,
                                  auto line) {
    const testing::ProgramRun run =
        run_tribench({"loop", file_of(folder, header, 12, 20, line), "--json"});
    ASSERT_EQ(run.status, status) << run.errors;
    const Json loop = Json::parse(run.output);
    EXPECT_EQ(loop["verdict"], verdict) << header;
    EXPECT_TRUE(loop["effects"].empty()) << header;
  };
  // No noise at all: the base leaves no residual.
  expect_nothing("movement,velocity_rad_s,friction_torque_Nm", "NONE", 0, [](int m, int) {
    const double v = speed_of(m);
    return csv({1.0 * m, v, (v > 0 ? 5 : -5) + 3 * v});
  });
  // Acceleration zero throughout, gravity the same everywhere.
  expect_nothing("movement,velocity_rad_s,acceleration_rad_s2,gravity_torque_Nm,friction_torque_Nm",
                 "CANNOT_TELL", 4, [](int m, int i) {
                   return csv({1.0 * m, speed_of(m), 0, 7, friction_of(speed_of(m), m, i)});
                 });
  // The same column twice, under two roles: gravity and position in step.
  expect_nothing("movement,velocity_rad_s,position_rad,gravity_torque_Nm,friction_torque_Nm",
                 "CANNOT_TELL", 4, [](int m, int i) {
                   const double q = 0.05 * i;
                   return csv({1.0 * m, speed_of(m), q, q, friction_of(speed_of(m), m, i)});
                 });
}

TEST(LoopCommand, MovementsOfOneKindAreLeftOutTogether) {
  const testing::TemporaryFolder folder;
  const auto line = [](int m, int i) {
    return csv({1.0 * m, speed_of(m), friction_of(speed_of(m), m, i)}) + "," +
           (m % 3 == 0   ? "slow"
            : m % 3 == 1 ? "fast"
                         : "loaded");
  };
  const std::string file =
      file_of(folder, "movement,velocity_rad_s,friction_torque_Nm,kind", 12, 20, line);
  const testing::ProgramRun run = run_tribench({"loop", file, "--leave-out", "kind", "--json"});
  ASSERT_EQ(run.status, 4) << run.errors;  // too few stretches to tell; the errors are judged
  const Json loop = Json::parse(run.output);
  EXPECT_EQ(loop["error"]["how"], "movements of one 'kind' left out in turn");
  EXPECT_EQ(loop["error"]["test_movements"], 12);
}

TEST(LoopCommand, SaysTheSameWithAnyNumberOfThreads) {
  const testing::TemporaryFolder folder;
  const std::string file = file_of(folder, kPlainHeader, 8, 80, plain_line);
  const std::string alone = run_tribench({"loop", file, "--json", "--jobs", "1"}).output;
  const Json answer = Json::parse(alone);
  EXPECT_GT(answer["error"]["rmse_after"], 0);
  EXPECT_EQ(run_tribench({"loop", file, "--json", "--jobs", "3"}).output, alone);
}

TEST(LoopCommand, OneRowAMovementIsRefusedWithTheReason) {
  const testing::TemporaryFolder folder;
  const testing::ProgramRun run = run_tribench({"loop", generated(folder, "A/j2/no_load", "1")});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("no movement has the 5 rows"));
}

TEST(LoopCommand, WritesItsThreeFilesAndTheNextMovements) {
  const testing::TemporaryFolder folder;
  const std::string data = generated(folder, "undeclared/power_quadrant_gain/0.5", "1");
  const std::string out = (folder / "out").string();
  const testing::ProgramRun run =
      run_tribench({"loop", data, "--any-sign", "--suggest", "2", "--out", out, "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json loop = Json::parse(run.output);
  EXPECT_EQ(families(loop), std::vector<std::string>{"power_quadrant_gain"});
  EXPECT_LE(loop["next_movements"].size(), 2U);
  ASSERT_GE(loop["next_movements"].size(), 1U);
  EXPECT_GT(loop["next_movements"][0]["separation"].get<double>(), 0);
  for (const char* name : {"out/loop.json", "out/loop.md", "out/loop.html"}) {
    EXPECT_GT(std::filesystem::file_size(folder / name), 1000U) << name;
  }
  EXPECT_THAT(testing::read_text(folder / "out/next_movements.csv"),
              HasSubstr("order,kind,velocity_rad_s,from_rad,to_rad,load_factor,duration_s"));
  EXPECT_THAT(testing::read_text(folder / "out/loop.md"), HasSubstr("## Next movements"));
  // Not asked for again: what an earlier run proposed is no answer to this one.
  EXPECT_EQ(run_tribench({"loop", data, "--out", out}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/next_movements.csv"));
}

// A log that holds what is missing under a name that nobody knows.
TEST(LoopCommand, AColumnWithoutARoleThatExplainsWhatIsLeftIsPointedAt) {
  const testing::TemporaryFolder folder;
  const std::string data = generated(folder, "undeclared/coupling/2", "3");
  std::string text = testing::read_text(data);
  for (const auto& [name, other] : {std::pair("other_velocity_rad_s", "neighbour"),
                                    std::pair("other_acceleration_rad_s2", "second")}) {
    ASSERT_NE(text.find(name), std::string::npos);
    text.replace(text.find(name), std::string_view(name).size(), other);
  }
  testing::write_text(data, text);
  const std::string out = (folder / "out").string();
  const testing::ProgramRun bare = run_tribench({"loop", data, "--any-sign", "--out", out});
  EXPECT_THAT(bare.output, HasSubstr("'neighbour' ("));
  EXPECT_THAT(bare.output, HasSubstr("--roles 'neighbour=ROLE'"));
  const Json record = Json::parse(testing::read_text(out + "/loop.json"));
  EXPECT_EQ(record["unused_columns"][0]["column"], "neighbour");
  EXPECT_GT(record["unused_columns"][0]["explains"], 0.05);
  EXPECT_THAT(testing::read_text(out + "/loop.md"), HasSubstr("'neighbour' ("));
  // Told to be nothing it is no question any more; told what it is, it is an effect.
  const testing::ProgramRun none =
      run_tribench({"loop", data, "--any-sign", "--roles", "neighbour=none"});
  EXPECT_THAT(none.output, Not(HasSubstr("neighbour")));
  const testing::ProgramRun told =
      run_tribench({"loop", data, "--any-sign", "--json", "--roles", "neighbour=other_velocity"});
  EXPECT_EQ(families(Json::parse(told.output)), std::vector<std::string>{"coupling"});
}

// derived_channels_test.cpp compiles such code and holds it to the loop's own values.
TEST(LoopCommand, WhatItFoundIsExportedAsCWithTheHistoryItNeeds) {
  const testing::TemporaryFolder folder;
  const std::string data = generated(folder, "undeclared/hysteresis/2", "1");
  const std::string out = (folder / "out").string();
  const testing::ProgramRun run =
      run_tribench({"loop", data, "--any-sign", "--out", out, "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(families(Json::parse(run.output)), std::vector<std::string>{"hysteresis"});
  const testing::ProgramRun code = run_tribench({"export", out + "/loop.json", "--as", "c"});
  ASSERT_EQ(code.status, 0) << code.errors;
  EXPECT_THAT(code.output, HasSubstr("double friction(double v, double d)"));
  EXPECT_THAT(
      code.output,
      HasSubstr("double friction_step(friction_history *h, double v, double q, double dt)"));
  EXPECT_EQ(run_tribench({"export", out + "/loop.md", "--as", "c"}).status, 2);
  for (const char* text : {"{}", "[]", R"({"formula": {}, "symbols": [1]})"}) {
    testing::write_text(folder / "other.json", text);
    const testing::ProgramRun other =
        run_tribench({"export", (folder / "other.json").string(), "--as", "c"});
    EXPECT_EQ(other.status, 2) << text;
    EXPECT_THAT(other.errors, HasSubstr("no loop.json")) << text;
  }
  EXPECT_THAT(run_tribench({"export", "2*v", "--as", "c", "--derive", "d=q"}).errors,
              HasSubstr("no input d"));
  EXPECT_THAT(run_tribench({"export", "d*v", "--as", "c", "--derive", "d=x"}).errors,
              HasSubstr("write d=q"));
}

// What is a quarter of the noise can be told and yet do nothing on the movements left out.
TEST(LoopCommand, WhatTheMovementsLeftOutDoNotConfirmIsProvisional) {
  const testing::TemporaryFolder folder;
  for (const auto& [problem, is_confirmed] :
       {std::pair{"undeclared/hysteresis/0.25", false}, {"undeclared/stribeck/2", true}}) {
    const Json told = Json::parse(
        run_tribench({"loop", generated(folder, problem, "12"), "--any-sign", "--json"}).output);
    ASSERT_EQ(told["effects"].size(), 1U) << problem;
    EXPECT_EQ(told["error"]["confirmed"].get<bool>(), is_confirmed) << problem;
    EXPECT_EQ(told["effects"][0]["provisional"].get<bool>(), !is_confirmed) << problem;
  }
}

// A fall with speed that a sixth of the searches find: it goes where it stands for a ripple that
// most find, and where it stands beside that.
TEST(LoopCommand, NamesNothingThatFewOfTheSearchesOnPartsChoose) {
  const auto data = testing::shared_data();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  const testing::ProgramRun run =
      run_tribench({"loop", (*data / "ur10e-dynamic/joint1_dynamic.csv").string(), "--roles",
                    "rigid_current_A=gravity_torque", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json loop = Json::parse(run.output);
  ASSERT_FALSE(loop["effects"].empty());
  for (const Json& effect : loop["effects"]) EXPECT_GE(effect["chosen_share"], 0.6) << effect;
}

// As small a bump is no ripple.
TEST(LoopCommand, ABumpOfAQuarterOfTheNoiseIsUnknownInPosition) {
  const testing::TemporaryFolder folder;
  const std::string data = generated(folder, "undeclared/position_bump/0.25", "12");
  const Json told = Json::parse(run_tribench({"loop", data, "--any-sign", "--json"}).output);
  EXPECT_EQ(told["verdict"], "UNKNOWN");
  EXPECT_TRUE(told["effects"].empty());
  EXPECT_EQ(told["leftover"]["inputs"], Json::array({"position"}));
}

TEST(LoopCommand, GrowsAnEffectFromWhatIsLeftOverSavesItAndReadsItBack) {
  const testing::TemporaryFolder folder;
  const std::string first = generated(folder, "undeclared/position_bump/2", "1");
  const std::string effect = (folder / "effect.toml").string();
  const testing::ProgramRun learning =
      run_tribench({"loop", first, "--any-sign", "--gear-ratio", "160", "--learn", "pysr",
                    "--learn-evaluations", "20000000", "--save-effect", effect, "--json"});
  ASSERT_EQ(learning.status, 0) << learning.errors;
  const Json grown = Json::parse(learning.output);
  ASSERT_EQ(grown["learned"].size(), 1U);
  EXPECT_TRUE(grown["learned"][0]["accepted"]);
  EXPECT_LE(grown["learned"][0]["p_adj"].get<double>(), 0.003);
  EXPECT_GE(grown["learned"][0]["tested_on_movements"].get<int>(), 40);
  EXPECT_EQ(families(grown), std::vector<std::string>{"learned:position"});
  EXPECT_LT(grown["error"]["mae_after"], 0.75 * grown["error"]["mae_before"].get<double>());

  // On another campaign, from the file.
  const std::string second = generated(folder, "undeclared/position_bump/2", "2");
  const testing::ProgramRun reading = run_tribench(
      {"loop", second, "--any-sign", "--gear-ratio", "160", "--learned", effect, "--json"});
  ASSERT_EQ(reading.status, 0) << reading.errors;
  const Json known = Json::parse(reading.output);
  EXPECT_EQ(families(known), std::vector<std::string>{"learned:position"});
  EXPECT_LT(known["error"]["mae_after"], 0.75 * known["error"]["mae_before"].get<double>());

  testing::write_text(folder / "broken.toml", "[[effect]]\nname = \"x\"\n");
  for (const char* more : {"--json", "--explain"}) {
    const testing::ProgramRun broken =
        run_tribench({"loop", second, "--learned", (folder / "broken.toml").string(), more});
    EXPECT_EQ(broken.status, 2) << more;
    EXPECT_THAT(broken.errors, HasSubstr("phrase")) << more;
  }
}

}  // namespace
}  // namespace tribench
