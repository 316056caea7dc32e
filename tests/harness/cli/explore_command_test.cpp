// SPDX-License-Identifier: MIT
//
// A robot's own program in the place of a world: what it may print, and what is left when it fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "problems/experiment/planned_movement.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A robot that is a world: `before` is done before each movement, `filter` to its recording.
class ExploreByProgram : public ::testing::Test {
 protected:
  std::string make_robot(const std::string& name, const std::string& before = "",
                         const std::string& filter = "cat") {
    const std::string world = (folder_ / (name + ".world")).string();
    EXPECT_EQ(run_tribench({"world", "7", "--out", world}).status, 0);
    const std::string script = (folder_ / (name + ".sh")).string();
    write_text(script, before + "\nd=$(mktemp) && '" + program().string() + "' world '" + world +
                           "' execute \"$1\" --out $d >&2 || exit $?\n" + filter +
                           " < $d; rm $d\n");
    write_text(folder_ / "limits.json", read_text(world + "/world.json"));
    return script;
  }
  ProgramRun explore(const std::string& robot, const std::string& out,
                     const std::string& budget = "25", const std::string& seed = "1") {
    return run_tribench({"explore", "--limits", (folder_ / "limits.json").string(), "--budget",
                         budget, "--seed", seed, "--out", (folder_ / out).string(), "--command",
                         "sh", robot});
  }
  json path_of(const std::string& out) {
    return json::parse(read_text(folder_ / out / "exploration.json"))["path"];
  }

  TemporaryFolder folder_;
};

TEST_F(ExploreByProgram, AFailureLosesNothingAndTheSameCommandGoesOn) {
  const std::string calls = (folder_ / "calls").string();
  const std::string robot = make_robot("a", "echo >> " + calls + "; if [ $(wc -l < " + calls +
                                                ") = 7 ]; then echo 'brake' >&2; exit 7; fi");
  const ProgramRun failed = explore(robot, "x");
  EXPECT_EQ(failed.status, 3);
  EXPECT_THAT(failed.errors, AllOf(HasSubstr("the program ended with status 7: brake"),
                                   HasSubstr("the same command goes on from there")));
  EXPECT_EQ(path_of("x").size(), 6U);
  EXPECT_THAT(read_text(folder_ / "x/data.csv"), HasSubstr("move 6"));
  EXPECT_EQ(explore(robot, "x", "25", "5").status, 2) << "another exploration";
  EXPECT_EQ(explore(robot, "x", "30").status, 2) << "its end would be another";
  EXPECT_EQ(explore(robot, "x").status, 4);
  ASSERT_EQ(explore(make_robot("b"), "whole").status, 4);
  EXPECT_EQ(path_of("x"), path_of("whole"));
  EXPECT_EQ(read_text(folder_ / "x/data.csv"), read_text(folder_ / "whole/data.csv"));
}

// A person's Ctrl-C waits for the movement; the machine's SIGTERM lets the program brake.
TEST_F(ExploreByProgram, TheMachinesSignalBreaksTheMovementOff) {
  const std::string robot =
      make_robot("a", "cd '" + folder_.path().string() + "'; echo >> calls\n" +
                          "if [ $(wc -l < calls) = 4 ]; then trap 'touch braked; exit 9' TERM\n" +
                          "touch moving; for i in $(seq 400); do sleep 0.05; done; fi");
  write_text(folder_ / "end.sh", "cd \"$1\"\n'" + program().string() +
                                     "' explore --limits limits.json --budget 25 --seed 1 --out x "
                                     "--command sh " +
                                     robot +
                                     " &\n"
                                     "while [ ! -e moving ]; do sleep 0.01; done\n"
                                     "kill -TERM $!; wait $!\n");
  const ProgramRun ended =
      run_to_end({"sh", (folder_ / "end.sh").string(), folder_.path().string()});
  EXPECT_EQ(ended.status, 3);
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("the movement was broken off"),
                                  HasSubstr("the same command goes on from there")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "braked"));
  EXPECT_EQ(path_of("x").size(), 3U);
}

// What was cut off was not answered: it is asked for again, in a line of its own.
TEST_F(ExploreByProgram, ALineThatWasCutOffIsAskedForAgain) {
  const std::string robot = make_robot("a");
  ASSERT_EQ(explore(robot, "x").status, 4);
  const std::string journal = read_text(folder_ / "x/journal.jsonl");
  const std::size_t last = journal.rfind('\n', journal.size() - 2) + 1;
  write_text(folder_ / "x/journal.jsonl", journal.substr(0, last + 40));
  // The robot has moved on since: what it records now is not what it was.
  ASSERT_EQ(explore(robot, "x").status, 4);
  const std::string again = read_text(folder_ / "x/journal.jsonl");
  EXPECT_EQ(again.substr(0, last + 20), journal.substr(0, last + 20));
  EXPECT_EQ(std::ranges::count(again, '\n'), std::ranges::count(journal, '\n'));
  EXPECT_EQ(explore(robot, "x").status, 4) << "and can be read again";
}

TEST_F(ExploreByProgram, ReadsTheUnitsOfTheHeaderAndWritesWhatItHasRead) {
  const std::string robot = make_robot("a", "",
                                       "awk -F, -v OFS=, 'NR == 1 { sub(\"time_s\", \"time_ms\"); "
                                       "print; next } { $2 *= 1000; print }'");
  ASSERT_EQ(explore(robot, "x").status, 4);
  const std::string data = read_text(folder_ / "x/data.csv");
  EXPECT_THAT(data, AllOf(HasSubstr("time_s,"), Not(HasSubstr("time_ms"))));
  EXPECT_NE(run_tribench({"loop", (folder_ / "x/data.csv").string()}).status, 2);
}

TEST_F(ExploreByProgram, AsksForWhatTheFirstRecordingLacks) {
  const auto says = [&](const std::string& name, const std::string& columns) {
    const std::string robot = make_robot(name, "", "cut -d, -f" + columns);
    const ProgramRun run = explore(robot, name + ".x");
    EXPECT_EQ(run.status, 3);
    return run.errors;
  };
  EXPECT_THAT(says("still", "1-3,5-"), HasSubstr("the recording has no velocity"));
  EXPECT_THAT(says("free", "1-8"), HasSubstr("neither friction_torque_Nm nor motor_torque_Nm"));
}

TEST_F(ExploreByProgram, AClockThatBeginsAnewRunsOn) {
  const std::string anew = make_robot(
      "a", "", "awk -F, -v OFS=, 'NR == 1 { print; next } NR == 2 { t = $2 } { $2 -= t; print }'");
  ASSERT_EQ(explore(anew, "x").status, 4);
  // Where the exploration goes on, too.
  const std::string journal = read_text(folder_ / "x/journal.jsonl");
  write_text(folder_ / "x/journal.jsonl",
             journal.substr(0, journal.rfind('\n', journal.size() - 2) + 1));
  ASSERT_EQ(explore(anew, "x").status, 4);
  std::istringstream data(read_text(folder_ / "x/data.csv"));
  double last = -1;
  std::string line;
  std::getline(data, line);
  while (std::getline(data, line)) {
    const double time = std::stod(line.substr(line.find(',') + 1));
    EXPECT_GT(time, last);
    last = time;
  }
}

// Each was believed, and became effects or, in numbers that are none, a sure NONE.
TEST_F(ExploreByProgram, RefusesARecordingThatIsNotTheMovement) {
  const auto says = [&](const std::string& name, const std::string& change) {
    const std::string robot =
        make_robot(name, "", "awk -F, -v OFS=, 'NR > 1 { " + change + " } { print }'");
    const ProgramRun run = explore(robot, name + ".x");
    EXPECT_EQ(run.status, 3);
    return run.errors;
  };
  EXPECT_THAT(says("degrees", "$3 *= 57.29578; $4 *= 57.29578"),
              AllOf(HasSubstr("the recording goes from"), HasSubstr("and the limits from"),
                    HasSubstr("position_deg")));
  EXPECT_THAT(says("rpm", "$4 *= 9.549297"), HasSubstr("where the velocity says"));
  EXPECT_THAT(says("turned", "$4 = -$4"), HasSubstr("where the velocity says"));
  EXPECT_THAT(says("still", "$3 = 0.1"), HasSubstr("was asked for"));
}

TEST_F(ExploreByProgram, TheBudgetMayBeInMinutesAndHours) {
  const std::string robot = make_robot("a");
  EXPECT_EQ(explore(robot, "x", "15").status, 4);
  EXPECT_EQ(explore(robot, "x", "0.25m").status, 4) << "the same exploration";
  EXPECT_EQ(explore(robot, "x", "15s").status, 4);
  EXPECT_EQ(explore(robot, "x", "0.25h").status, 2) << "its end would be another";
  EXPECT_THAT(explore(robot, "x", "10min").errors,
              HasSubstr("'10min' cannot be used; use a number of seconds (600, 600s), minutes"));
}

TEST_F(ExploreByProgram, LimitsThatNobodyHasSetMoveNoJoint) {
  const std::string robot = make_robot("a");
  write_text(folder_ / "limits.json", R"({"lowest_rad": -1, "highest_rad": 1, "torque_Nm": 9})");
  const ProgramRun run = explore(robot, "x");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors,
              HasSubstr("the limits lack speed_rad_s, acceleration_rad_s2, rate_Hz, gear_ratio"));
}

// A joint whose gravity takes more than its motor gives away from the middle.
TEST_F(ExploreByProgram, IsNotAskedForWhatGravityAloneForbids) {
  const std::string asked = (folder_ / "asked").string();
  const std::string robot = make_robot("a", "cat \"$1\" >> " + asked);
  json limits = json::parse(read_text(folder_ / "limits.json"))["limits"];
  limits["lowest_rad"] = -1;
  limits["highest_rad"] = 1;
  limits["gravity_Nm"] = 12;
  limits["gravity_phase_rad"] = 0;
  limits["least_load_factor"] = limits["greatest_load_factor"] = 1;
  limits["torque_Nm"] = 8;
  write_text(folder_ / "limits.json", limits.dump());
  explore(robot, "x");
  std::istringstream lines(read_text(asked));
  std::string names;
  std::string values;
  std::size_t count = 0;
  for (; std::getline(lines, names) && std::getline(lines, values); ++count) {
    const PlannedMovement movement = read_movements(names + "\n" + values + "\n", "asked").front();
    const double farthest = std::max(std::abs(movement.from), std::abs(movement.to));
    EXPECT_LE(12 * std::sin(farthest), 8) << values;
  }
  EXPECT_GT(count, 3U);
}

TEST_F(ExploreByProgram, LimitsThatNoMovementKeepsMoveNoJoint) {
  const std::string asked = (folder_ / "asked").string();
  const std::string robot = make_robot("a", "touch " + asked);
  json limits = json::parse(read_text(folder_ / "limits.json"))["limits"];
  limits["gravity_Nm"] = 12;
  limits["torque_Nm"] = 0.01;
  write_text(folder_ / "limits.json", limits.dump());
  const ProgramRun run = explore(robot, "x");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("no movement keeps the limits"));
  EXPECT_FALSE(std::filesystem::exists(asked));
}

TEST_F(ExploreByProgram, AProgramAndItsWordsMayComeInQuotes) {
  const std::string robot = make_robot("a");
  const auto run = [&](const std::string& command) {
    return run_tribench({"explore", "--limits", (folder_ / "limits.json").string(), "--budget",
                         "10", "--command", command});
  };
  EXPECT_EQ(run("sh -e '" + robot + "'").status, 4);
  const ProgramRun open = run("sh -e '" + robot);
  EXPECT_EQ(open.status, 2);
  EXPECT_THAT(open.errors, HasSubstr("is no command"));
}

}  // namespace
}  // namespace tribench::testing
