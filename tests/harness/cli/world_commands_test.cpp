// SPDX-License-Identifier: MIT
//
// world, explore and challenge, as a user calls them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "problems/file_hash.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kHeader = "kind,velocity_rad_s,from_rad,to_rad\n";
constexpr const char* kThere = "constant,0.3,-1,1\n";
constexpr const char* kBack = "constant,-0.4,1,-1\n";

// The lines of a recording without their movement's name.
std::vector<std::string> rows_of(const std::string& text) {
  std::vector<std::string> rows;
  std::size_t begin = text.find('\n') + 1;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    rows.push_back(
        text.substr(begin, end - begin).substr(text.substr(begin, end - begin).find(',')));
    begin = end + 1;
  }
  return rows;
}

TEST(WorldCommand, RecordsTheSameInOneCallAndInTwo) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  for (const char* world : {"a", "b"}) {
    ASSERT_EQ(run_tribench({"world", "7", "--out", path(world)}).status, 0);
  }
  write_text(folder / "both.csv", std::string(kHeader) + kThere + kBack);
  write_text(folder / "there.csv", std::string(kHeader) + kThere);
  write_text(folder / "back.csv", std::string(kHeader) + kBack);
  const auto run = [&](const char* world, const char* movements, const char* out) {
    const ProgramRun done = run_tribench(
        {"world", path(world), "execute", path(movements), "--out", path(out), "--json"});
    EXPECT_EQ(done.status, 0) << done.errors;
    return json::parse(done.output);
  };
  const json both = run("a", "both.csv", "ab.csv");
  run("b", "there.csv", "b1.csv");
  const json back = run("b", "back.csv", "b2.csv");
  EXPECT_EQ(both["seconds_used"], back["seconds_used"]);
  EXPECT_GT(both["seconds_used"].get<double>(), 2 / 0.3 + 2 / 0.4);
  std::vector<std::string> parts = rows_of(read_text(folder / "b1.csv"));
  for (const std::string& row : rows_of(read_text(folder / "b2.csv"))) parts.push_back(row);
  EXPECT_EQ(rows_of(read_text(folder / "ab.csv")), parts);
}

TEST(WorldCommand, RefusesWithRowAndMendAndDoesNothing) {
  const TemporaryFolder folder;
  const std::string world = (folder / "w").string();
  ASSERT_EQ(run_tribench({"world", "7", "--out", world}).status, 0);
  write_text(folder / "m.csv", std::string(kHeader) + kThere + "constant,9,-1,1\n");
  const ProgramRun refused = run_tribench({"world", world, "execute", (folder / "m.csv").string(),
                                           "--out", (folder / "d.csv").string()});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("m.csv, movement 2"));
  EXPECT_THAT(refused.errors, HasSubstr("rad/s at most"));
  EXPECT_FALSE(std::filesystem::exists(folder / "d.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "w/executed.csv"));
  EXPECT_EQ(run_tribench({"world", "7", "--out", world}).status, 2);
  EXPECT_EQ(run_tribench({"world", (folder / "none").string(), "reveal"}).status, 2);
  EXPECT_EQ(run_tribench({"world", "seven", "--out", (folder / "x").string()}).status, 2);
}

// The seconds would be spent and the rows lost.
TEST(WorldCommand, NothingIsExecutedWhereTheRecordingCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string simulated = (folder / "w").string();
  const std::string recorded = (folder / "r").string();
  ASSERT_EQ(run_tribench({"world", "7", "--out", simulated}).status, 0);
  write_text(folder / "m.csv", std::string(kHeader) + kThere);
  const auto execute = [&](const std::string& world, const char* out) {
    return run_tribench({"world", world, "execute", (folder / "m.csv").string(), "--out",
                         (folder / out).string(), "--json"});
  };
  const auto refused_first = [&](const std::string& world) {
    const ProgramRun refused = execute(world, "none/d.csv");
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.errors, HasSubstr("none/d.csv"));
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(world) / "executed.csv"));
    const ProgramRun done = execute(world, "d.csv");
    EXPECT_EQ(done.status, 0) << done.errors;
    const json cost = json::parse(done.output);
    EXPECT_EQ(cost["seconds_used"], cost["seconds"]);
  };
  refused_first(simulated);
  write_text(folder / "m.csv", std::string(kHeader) + "constant,0.3,-0.9,0.9\n");
  ASSERT_EQ(run_tribench({"world", (folder / "d.csv").string(), "--out", recorded}).status, 0);
  refused_first(recorded);
}

// A disk that is full at the end: the same movements are to be had again.
TEST(WorldCommand, ARecordingThatIsLostIsNotCounted) {
  const TemporaryFolder folder;
  const std::string simulated = (folder / "w").string();
  const std::string recorded = (folder / "r").string();
  ASSERT_EQ(run_tribench({"world", "7", "--out", simulated}).status, 0);
  write_text(folder / "m.csv", std::string(kHeader) + "constant,0.3,-0.9,0.9\n");
  const auto execute = [&](const std::string& world, const std::string& out) {
    return run_tribench(
        {"world", world, "execute", (folder / "m.csv").string(), "--out", out, "--json"});
  };
  const auto counts_only_what_is_kept = [&](const std::string& world) {
    EXPECT_EQ(execute(world, "/dev/full").status, 3);
    const ProgramRun done = execute(world, (folder / "d.csv").string());
    ASSERT_EQ(done.status, 0) << done.errors;
    const json cost = json::parse(done.output);
    EXPECT_EQ(cost["seconds_used"], cost["seconds"]);
  };
  counts_only_what_is_kept(simulated);
  write_text(folder / "m.csv", std::string(kHeader) + "constant,0.3,-0.8,0.8\n");
  ASSERT_EQ(run_tribench({"world", (folder / "d.csv").string(), "--out", recorded}).status, 0);
  counts_only_what_is_kept(recorded);
}

TEST(WorldCommand, RevealsWhatTheSealSaidAndNothingIsAskedAfterwards) {
  const TemporaryFolder folder;
  const std::string world = (folder / "w").string();
  const ProgramRun made = run_tribench({"world", "11", "--kind", "pair", "--out", world, "--json"});
  ASSERT_EQ(made.status, 0) << made.errors;
  const std::string seal = json::parse(made.output)["truth_sha256"];
  EXPECT_THAT(read_text(folder / "w/world.json"), Not(HasSubstr("cause")));
  EXPECT_EQ(json::parse(read_text(folder / "w/world.json"))["smallest_effect"], 1);
  const ProgramRun revealed = run_tribench({"world", world, "reveal", "--json"});
  ASSERT_EQ(revealed.status, 0) << revealed.errors;
  const auto answer = nlohmann::ordered_json::parse(revealed.output);
  EXPECT_EQ(answer["truth"]["causes"].size(), 2U);
  EXPECT_EQ(sha256_of_text(answer["key"].get<std::string>() + "\n" + answer["truth"].dump()), seal);
  write_text(folder / "m.csv", std::string(kHeader) + kThere);
  const ProgramRun late = run_tribench({"world", world, "execute", (folder / "m.csv").string(),
                                        "--out", (folder / "d.csv").string()});
  EXPECT_EQ(late.status, 2);
  EXPECT_THAT(late.errors, HasSubstr("revealed"));
}

// As a version that draws other worlds from the same seed would leave it.
TEST(WorldCommand, AWorldWhoseSealDoesNotFitIsNotGoneOnWith) {
  const TemporaryFolder folder;
  const std::string world = (folder / "w").string();
  ASSERT_EQ(run_tribench({"world", "11", "--out", world}).status, 0);
  json known = json::parse(read_text(folder / "w/world.json"));
  known["truth_sha256"] = std::string(64, '0');
  write_text(folder / "w/world.json", known.dump());
  write_text(folder / "m.csv", std::string(kHeader) + kThere);
  const ProgramRun refused = run_tribench({"world", world, "execute", (folder / "m.csv").string(),
                                           "--out", (folder / "d.csv").string()});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("another version"));
  EXPECT_FALSE(std::filesystem::exists(folder / "d.csv"));
}

// What was recorded is given as it was recorded, the nearest that is left first, each once.
TEST(WorldCommand, RecordingsAreAWorldOfTheirOwn) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  ASSERT_EQ(run_tribench({"world", "7", "--out", path("joint")}).status, 0);
  write_text(folder / "all.csv", std::string(kHeader) + kThere + kBack);
  ASSERT_EQ(run_tribench(
                {"world", path("joint"), "execute", path("all.csv"), "--out", path("recorded.csv")})
                .status,
            0);
  const ProgramRun made =
      run_tribench({"world", path("recorded.csv"), "--longest", "100", "--out", path("again")});
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(made.output, HasSubstr("2 recorded movements"));
  write_text(folder / "back.csv", std::string(kHeader) + "constant,-0.3,0.9,-0.9\n");
  const auto ask = [&] {
    return run_tribench({"world", path("again"), "execute", path("back.csv"), "--out",
                         path("given.csv"), "--json"});
  };
  const ProgramRun first = ask();
  ASSERT_EQ(first.status, 0) << first.errors;
  EXPECT_EQ(json::parse(first.output)["given"], json::array({"move 2"}));
  const std::vector<std::string> all = rows_of(read_text(folder / "recorded.csv"));
  const std::vector<std::string> given = rows_of(read_text(folder / "given.csv"));
  ASSERT_LT(given.size(), all.size());
  EXPECT_TRUE(std::ranges::equal(given, std::vector(all.end() - std::ssize(given), all.end())));
  EXPECT_EQ(json::parse(ask().output)["given"], json::array({"move 1"}));
  const ProgramRun third = ask();
  EXPECT_EQ(third.status, 2);
  EXPECT_THAT(third.errors, HasSubstr("all 2 recorded movements have been given"));
  const ProgramRun told = run_tribench({"world", path("again"), "reveal"});
  EXPECT_EQ(told.status, 2);
  EXPECT_THAT(told.errors, HasSubstr("nobody knows what a recorded joint hides"));
  // A list of movements that somebody lengthened.
  const std::string list = read_text(folder / "again/executed.csv");
  write_text(folder / "again/executed.csv", list + rows_of(list).back() + "\n");
  const ProgramRun longer = ask();
  EXPECT_EQ(longer.status, 2);
  EXPECT_THAT(longer.errors, HasSubstr("3 movements were asked for, and there are 2 recordings"));
}

TEST(ExploreCommand, WritesItsPathAndSaysWhenItIsNotSure) {
  const TemporaryFolder folder;
  const std::string world = (folder / "w").string();
  ASSERT_EQ(run_tribench({"world", "7", "--out", world}).status, 0);
  const ProgramRun done = run_tribench(
      {"explore", world, "--budget", "25s", "--out", (folder / "x").string(), "--json"});
  EXPECT_EQ(done.status, 4) << done.errors;
  const json answer = json::parse(done.output);
  EXPECT_LE(answer["seconds"].get<double>(), 25);
  EXPECT_GE(answer["path"].size(), 5U);
  EXPECT_NE(answer["end"], "sure");
  EXPECT_EQ(read_text(folder / "x/exploration.json"), done.output);
  EXPECT_THAT(read_text(folder / "x/exploration.md"), HasSubstr("| movement |"));
  // What was asked can be asked again: the same recording.
  const std::string again = (folder / "again").string();
  ASSERT_EQ(run_tribench({"world", "7", "--out", again}).status, 0);
  ASSERT_EQ(run_tribench({"world", again, "execute", (folder / "x/movements.csv").string(), "--out",
                          (folder / "d.csv").string()})
                .status,
            0);
  EXPECT_EQ(read_text(folder / "d.csv"), read_text(folder / "x/data.csv"));
}

TEST(ExploreCommand, AProgramTakesTheWorldsPlace) {
  const TemporaryFolder folder;
  const std::string world = (folder / "w").string();
  const std::string direct = (folder / "direct").string();
  for (const std::string& one : {world, direct}) {
    ASSERT_EQ(run_tribench({"world", "7", "--out", one}).status, 0);
  }
  write_text(folder / "robot.sh", "d=$(mktemp) && '" + program().string() + "' world '" + world +
                                      "' execute \"$1\" --out $d >&2 || exit $?\ncat $d; rm $d\n");
  const ProgramRun done = run_tribench({"explore", "--limits", (folder / "w/world.json").string(),
                                        "--budget", "18", "--smallest-effect", "1", "--json",
                                        "--command", "sh", (folder / "robot.sh").string()});
  EXPECT_EQ(done.status, 4) << done.errors;
  const ProgramRun same = run_tribench({"explore", direct, "--budget", "18", "--json"});
  EXPECT_EQ(json::parse(done.output)["path"], json::parse(same.output)["path"]);
  EXPECT_EQ(json::parse(same.output)["smallest_effect"], 1) << "what a world of its level says";
  EXPECT_EQ(run_tribench({"explore"}).status, 2);
  EXPECT_EQ(run_tribench({"explore", "--command", "true"}).status, 2);
  const ProgramRun broken = run_tribench(
      {"explore", "--limits", (folder / "w/world.json").string(), "--command", "false"});
  EXPECT_EQ(broken.status, 3);
  EXPECT_THAT(broken.errors, HasSubstr("status 1"));
}

// A program that asks for two movements, one of which is refused, and says what it was told to.
std::string entry(const std::string& verdict) {
  return "read hello\n"
         "echo '{\"movement\": {\"kind\": \"constant\", \"velocity_rad_s\": 0.3, "
         "\"from_rad\": -0.5, \"to_rad\": 0.5}}'\nread rows\n"
         "echo '{\"movement\": {\"kind\": \"constant\", \"velocity_rad_s\": 30, "
         "\"from_rad\": -0.5, \"to_rad\": 0.5}}'\nread refusal\n"
         "case $refusal in *refused*) ;; *) exit 1;; esac\n"
         "echo chatter\necho '{\"verdict\": " +
         verdict + "}'\n";
}

TEST(ChallengeCommand, SealsScoresAndRanksPrograms) {
  const TemporaryFolder folder;
  const std::string board = (folder / "board").string();
  const auto take = [&](const std::string& name, const std::string& verdict) {
    const std::string script = (folder / (name + ".sh")).string();
    write_text(script, entry(verdict));
    return run_tribench({"challenge", "--worlds", "6", "--name", name, "--out", board, "--json",
                         "--command", "sh", script});
  };
  const ProgramRun nothing = take("says-nothing", "{\"families\": [], \"unknown\": false}");
  ASSERT_EQ(nothing.status, 0) << nothing.errors << nothing.output;
  const ProgramRun silent = take("silent", "null");
  ASSERT_EQ(silent.status, 0);
  const ProgramRun broken = take("broken", "{]");
  EXPECT_EQ(broken.status, 3);
  const ProgramRun revealed = run_tribench({"challenge", "--worlds", "6", "--reveal"});
  const auto truths = nlohmann::ordered_json::parse(revealed.output);
  const auto seals = json::parse(read_text(folder / "board/seals.json"))["truth_sha256"];
  int none = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& world = truths["worlds"][k];
    none += world["truth"]["kind"] == "none" ? 1 : 0;
    EXPECT_EQ(sha256_of_text(world["key"].get<std::string>() + "\n" + world["truth"].dump()),
              seals[k]);
    EXPECT_EQ(sha256_of_text(world["sealed_text"].get<std::string>()), seals[k]);
  }
  const json score = json::parse(nothing.output);
  EXPECT_EQ(score["right"], none);
  EXPECT_EQ(score["wrong"], 6 - none);
  EXPECT_EQ(json::parse(silent.output)["wrong"], 0);
  const std::string leaderboard = read_text(folder / "board/leaderboard.md");
  for (const char* name : {"says-nothing", "silent", "broken"}) {
    EXPECT_THAT(leaderboard, HasSubstr(name));
  }
  EXPECT_LT(leaderboard.find("| silent |"), leaderboard.size());
}

TEST(ChallengeCommand, AFamilyThatThereIsNotIsNoVerdict) {
  const TemporaryFolder folder;
  const std::string script = (folder / "slip.sh").string();
  write_text(script, entry("{\"families\": [\"stribek\"], \"unknown\": false}"));
  const ProgramRun done = run_tribench({"challenge", "--worlds", "1", "--out",
                                        (folder / "board").string(), "--command", "sh", script});
  EXPECT_EQ(done.status, 3);
  const json score = json::parse(read_text(folder / "board/entry.json"));
  EXPECT_EQ(score["wrong"], 0);
  EXPECT_THAT(score["results"][0]["reason"].get<std::string>(), HasSubstr("stribeck"));
}

// Both sides would wait for the other until the world's time is over.
TEST(ChallengeCommand, AnObjectThatCannotBeReadEndsItsWorldAtOnce) {
  const TemporaryFolder folder;
  const std::string script = (folder / "nan.sh").string();
  write_text(
      script,
      "read hello\necho 'no {} object'\n"
      "echo '{\"movement\": {\"kind\": \"constant\", \"velocity_rad_s\": NaN}}'\nread rows\n");
  const ProgramRun done =
      run_tribench({"challenge", "--worlds", "1", "--wall-seconds", "5", "--out",
                    (folder / "board").string(), "--command", "sh", script});
  EXPECT_EQ(done.status, 3);
  EXPECT_THAT(done.output, HasSubstr("(NaN): '{\"movement\""));
  EXPECT_THAT(done.output, HasSubstr("every number finite"));
}

TEST(ChallengeCommand, RanksOnlyScoresOnTheSameWorlds) {
  const TemporaryFolder folder;
  const std::string board = (folder / "board").string();
  const std::string script = (folder / "silent.sh").string();
  write_text(script, entry("null"));
  write_text(folder / "secret.txt", "nobody knows this\n");
  const auto take = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"challenge", "--name", name, "--out", board};
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), {"--command", "sh", script});
    return run_tribench(words);
  };
  const std::vector<std::string> secret = {"--worlds", "2", "--secret-file",
                                           (folder / "secret.txt").string()};
  ASSERT_EQ(take("sealed", secret).status, 0);
  const std::string published = read_text(folder / "board/seals.json");
  // What was published stays.
  const std::vector<std::vector<std::string>> other_worlds = {{"--worlds", "2"}, {"--worlds", "3"}};
  for (const std::vector<std::string>& others : other_worlds) {
    const ProgramRun refused = take("practice", others);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.errors, HasSubstr("seals.json"));
    EXPECT_THAT(refused.errors, HasSubstr("another folder"));
    EXPECT_EQ(read_text(folder / "board/seals.json"), published);
    EXPECT_FALSE(std::filesystem::exists(folder / "board/practice.json"));
  }
  // A score that was carried here.
  json foreign = json::parse(read_text(folder / "board/sealed.json"));
  foreign["name"] = "practice";
  for (json& one : foreign["results"]) one["seal"] = "of another world";
  write_text(folder / "board/practice.json", foreign.dump());
  ASSERT_EQ(take("sealed", secret).status, 0);
  const std::string leaderboard = read_text(folder / "board/leaderboard.md");
  EXPECT_THAT(leaderboard, HasSubstr("| sealed |"));
  EXPECT_THAT(leaderboard, ::testing::Not(HasSubstr("| practice |")));
  EXPECT_THAT(leaderboard, HasSubstr("seals.json: practice"));
}

// The first program of "cut" waits until the challenge has been asked to end.
TEST(ChallengeCommand, WhatWasInterruptedIsNotRanked) {
  const TemporaryFolder folder;
  write_text(folder / "silent.sh", entry("null"));
  write_text(folder / "cut.sh",
             "read hello\ntouch \"$1/begun\"\n"
             "while [ ! -e \"$1/asked\" ]; do sleep 0.01; done\n"
             "echo '{\"verdict\": null}'\n");
  const std::string challenge = "'" + program().string() + "' challenge --worlds 3 --out board ";
  write_text(folder / "both.sh", "cd \"$1\"\n" + challenge +
                                     "--name whole --command sh silent.sh || exit\n" + challenge +
                                     "--name cut --command sh cut.sh . &\n"
                                     "while [ ! -e begun ]; do sleep 0.01; done\n"
                                     "kill -INT $!; touch asked; wait $!\n");
  const ProgramRun done = run_to_end({"sh", (folder / "both.sh").string(), folder.path().string()});
  EXPECT_EQ(done.status, 3) << done.errors;
  EXPECT_THAT(done.errors, HasSubstr("stopped: 1 of 3 worlds are done"));
  EXPECT_THAT(done.errors, HasSubstr("the same command begins anew"));
  const std::string leaderboard = read_text(folder / "board/leaderboard.md");
  EXPECT_THAT(leaderboard, HasSubstr("| 1 | whole |"));
  EXPECT_THAT(leaderboard, ::testing::Not(HasSubstr("| cut |")));
  EXPECT_THAT(leaderboard, HasSubstr("incomplete, with how many worlds: cut (1 of 3)."));
}

TEST(ChallengeCommand, TheEntryToBeginWithTakesPart) {
  const TemporaryFolder folder;
  const ProgramRun done = run_tribench({"challenge", "--worlds", "5", "--out",
                                        folder.path().string(), "--json", "--command", "python3",
                                        (source_dir() / "adapters/challenge_entry.py").string()});
  ASSERT_EQ(done.status, 0) << done.errors << done.output;
  const json score = json::parse(done.output);
  EXPECT_EQ(score["right"].get<int>() + score["wrong"].get<int>(), 5);
  EXPECT_GE(score["right"], 2);  // inertia and a ripple stand out
}

TEST(ChallengeCommand, AnotherSecretIsAnotherSetOfWorlds) {
  const TemporaryFolder folder;
  write_text(folder / "secret.txt", "nobody knows this\n");
  const ProgramRun one = run_tribench({"challenge", "--worlds", "3", "--reveal"});
  const ProgramRun two = run_tribench({"challenge", "--worlds", "3", "--secret-file",
                                       (folder / "secret.txt").string(), "--reveal"});
  EXPECT_NE(json::parse(one.output)["worlds"], json::parse(two.output)["worlds"]);
  EXPECT_EQ(run_tribench({"challenge"}).status, 2);
  write_text(folder / "blank.txt", " \n");
  const ProgramRun blank = run_tribench(
      {"challenge", "--worlds", "3", "--secret-file", (folder / "blank.txt").string(), "--reveal"});
  EXPECT_EQ(blank.status, 2);
  EXPECT_THAT(blank.errors, HasSubstr("holds no secret"));
}

TEST(StudyCommand, ExploreCountsSecondsAndErrors) {
  const TemporaryFolder folder;
  const ProgramRun done =
      run_tribench({"study", "explore", "--worlds", "2", "--plans", "sweep,sines", "--budget", "30",
                    "--json", "--out", folder.path().string()});
  ASSERT_EQ(done.status, 0) << done.errors;
  const json figures = json::parse(done.output);
  EXPECT_EQ(figures[0]["group"], "all");
  EXPECT_EQ(figures[0]["worlds"], 2);
  EXPECT_THAT(read_text(folder / "explorations.csv"), HasSubstr("medium,1,30,0.01,1,"));
  EXPECT_EQ(run_tribench({"study", "explore", "--plans", "swep"}).status, 2);
}

TEST(StudyCommand, ExploreGoesOnWithWhatItsFolderHas) {
  const TemporaryFolder folder;
  const auto run = [&] {
    return run_tribench({"study", "explore", "--worlds", "2", "--plans", "sweep,sines", "--budget",
                         "15", "--out", folder.path().string()});
  };
  ASSERT_EQ(run().status, 0);
  std::istringstream whole(read_text(folder / "explorations.csv"));
  std::string header;
  std::string first;
  std::getline(whole, header);
  std::getline(whole, first);
  // Of the others nothing is left but a torn line; the first is known by a figure of its own.
  const std::size_t before_aliases = first.rfind(',', first.rfind(',') - 1);
  const std::string marked = first.substr(0, first.rfind(',', before_aliases - 1)) + ",77.25,0,0";
  write_text(folder / "explorations.csv", header + "\n" + marked + "\nmedium,2,15,0.0");
  ASSERT_EQ(run().status, 0);
  const std::string again = read_text(folder / "explorations.csv");
  EXPECT_EQ(std::ranges::count(again, '\n'), 5);
  EXPECT_THAT(again, HasSubstr(marked + "\n"));
  write_text(folder / "explorations.csv", "a,b\n1,2\n");
  EXPECT_EQ(run().status, 2);
}

TEST(StudyCommand, RecordingsHeldBackAreAskedForUntilTheySayWhatAllSay) {
  const auto data = shared_data();
  if (!data) GTEST_SKIP() << kNoSharedData;
  const ProgramRun done =
      run_tribench({"study", "recordings", (*data / "ur10e-dynamic/joint4_dynamic.csv").string(),
                    "--roles", "recording=movement,rigid_current_A=gravity_torque", "--min-speed",
                    "0.05", "--unordered", "--gear-ratio", "100", "--orders", "0", "--json"});
  ASSERT_EQ(done.status, 0) << done.errors;
  const json found = json::parse(done.output);
  EXPECT_THAT(found["verdict"].get<std::string>(), HasSubstr("load_coulomb"));
  EXPECT_LT(found["asked"]["movements"], found["movements"]);
  EXPECT_EQ(found["path"].size(), found["asked"]["movements"]);
}

}  // namespace
}  // namespace tribench::testing
