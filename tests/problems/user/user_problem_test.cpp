// SPDX-License-Identifier: MIT
#include "problems/user/user_problem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "foundation/error.hpp"
#include "problems/file_hash.hpp"
#include "problems/user/user_problem_text.hpp"
#include "tests/support/paths.hpp"

namespace tribench::user {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class UserProblems : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::scratch_folder() /
              ("tribench_own_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "logs");
    // Rows of a subject are scattered: a, b, c, a, b, c, ...
    std::string text = "v,load,tau,subject,fold\n";
    for (int r = 0; r < 60; ++r) {
      text += std::to_string(r - 30) + "," + std::to_string(r % 7) + "," +
              std::to_string(2 * (r - 30)) + "," + "abcdefghij"[r % 10] + "," +
              std::to_string(r % 3) + "\n";
    }
    write("logs/one.csv", text);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text;
  }
  std::vector<UserProblem> parse(const std::string& toml) const {
    return parse_user_problems(toml, "g.toml", folder_);
  }
  Problem make(const std::string& more, std::uint64_t seed = 1) const {
    const std::string head =
        "[[problem]]\nname = \"mine\"\nfile = \"logs/one.csv\"\ntarget = \"tau\"\n";
    return make_user_problem(parse(head + more).front(), double_of_first, seed);
  }
  std::string refusal(const std::string& more) const {
    try {
      make(more);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return error.what();
    }
    return "accepted";
  }
  // A reader of laws that knows one: twice the first input.
  static suite::Law double_of_first(const std::string&, std::span<const std::string>) {
    return [](std::span<const double> point) { return 2 * point[0]; };
  }

  fs::path folder_;
};

std::set<int> movements_of(const Table& table) {
  return {table.movement.begin(), table.movement.end()};
}

TEST_F(UserProblems, ANoteAmongTheDataIsNoData) {
  write("logs/README.txt", "Logs of the elbow, by tau and v.\nRecorded in May, at 20 C.\n");
  write("logs/empty.txt", "");
  write("logs/two.txt", "v,load,tau [Nm]\n1,2,3\n2,3,4\n");
  const auto files = [](const UserProblem& own) {
    std::vector<std::string> names;
    for (const DataSource& source : own.files) names.push_back(source.file.filename().string());
    return names;
  };
  const std::string table = "[[problem]]\nname = \"mine\"\ntarget = \"tau\"\n";
  const UserProblem own = parse(table + "folder = \"logs\"\n").front();
  EXPECT_THAT(files(own), ElementsAre("one.csv", "two.txt"));
  EXPECT_EQ(own.passed_over,
            (std::vector<fs::path>{folder_ / "logs/README.txt", folder_ / "logs/empty.txt"}));
  // One that is named is data, and reading it says what it lacks; so where nothing else is there.
  EXPECT_THAT(files(parse(table + "file = \"logs/README.txt\"\n").front()),
              ElementsAre("README.txt"));
  EXPECT_THAT(files(parse(table + "glob = \"logs/[Re]*.txt\"\n").front()),
              ElementsAre("README.txt", "empty.txt"));
}

TEST_F(UserProblems, AConditionThatPicksNoRowIsNamedWithItsPlace) {
  EXPECT_THAT(refusal("where = \"fold\"\n"),
              AllOf(HasSubstr("g.toml:5:9: 'fold' is no COLUMN=VALUE"), HasSubstr("axis=2")));
  EXPECT_THAT(refusal("where = \"folt=1\"\n"),
              AllOf(HasSubstr("g.toml:5:9: "), HasSubstr("did you mean fold?")));
  EXPECT_THAT(refusal("where = \"fold=7\"\n"), HasSubstr("g.toml:5:9: no row has fold = 7"));
  EXPECT_THAT(refusal("where = \"fold=x\"\n"), HasSubstr("g.toml:5:9: 'x' is no number"));
}

TEST_F(UserProblems, AGroupIsKeptWholeHoweverItsRowsAreScattered) {
  const Problem problem = make(
      "inputs = [\"v\", \"load\"]\ngroup = \"subject\"\n"
      "split = { share = 0.3 }\n");
  const Table& train = problem.stages.front().train;
  EXPECT_EQ(train.rows() + problem.test.rows(), 60U);
  EXPECT_EQ(movements_of(train).size(), 7U);
  EXPECT_EQ(movements_of(problem.test).size(), 3U);
  for (const Table* table : {&train, &problem.test}) {
    for (std::size_t r = 0; r < table->rows(); ++r) {
      // Row r of the file has v = r - 30 and subject r % 10.
      EXPECT_EQ(table->movement[r], (static_cast<int>(table->columns[0][r]) + 30) % 10);
      EXPECT_EQ(table->target[r], 2 * table->columns[0][r]);
    }
    EXPECT_TRUE(std::ranges::is_sorted(table->movement));
  }
}

TEST_F(UserProblems, TheSeedDrawsTheSplitUnlessTheProblemDoes) {
  const auto tested = [&](const std::string& split, std::uint64_t seed) {
    return make("inputs = [\"v\"]\nsplit = " + split + "\n", seed).test.columns[0];
  };
  EXPECT_EQ(tested("{ share = 0.25 }", 1).size(), 15U);
  EXPECT_EQ(tested("{ share = 0.25 }", 1), tested("{ share = 0.25 }", 1));
  EXPECT_NE(tested("{ share = 0.25 }", 1), tested("{ share = 0.25 }", 2));
  EXPECT_EQ(tested("{ seeds = [7] }", 1), tested("{ seeds = [7] }", 2));
  EXPECT_EQ(tested("{ seeds = [7, 8] }", 2), tested("{ seeds = [8] }", 1));
  EXPECT_EQ(tested("{ seeds = [7, 8] }", 3), tested("{ seeds = [7] }", 1));
}

TEST_F(UserProblems, AColumnOrOtherFilesCanSayWhatTests) {
  const Problem by_column =
      make("inputs = [\"v\"]\nsplit = { column = \"fold\", values = [\"2\"] }\n");
  EXPECT_EQ(by_column.test.rows(), 20U);
  for (const double v : by_column.test.columns[0]) EXPECT_EQ((static_cast<int>(v) + 30) % 3, 2);
  write("logs/two.csv", "v,tau\n100,1\n-200,2\n");
  const Problem by_file = make("inputs = [\"v\"]\nsplit = { file = \"logs/two.csv\" }\n");
  EXPECT_EQ(by_file.stages.front().train.rows(), 60U);
  EXPECT_THAT(by_file.test.target, ElementsAre(1, 2));
  EXPECT_EQ(by_file.inputs[0].low, -200);
  EXPECT_EQ(by_file.inputs[0].high, 100);
}

// An error on rows that a method was trained on would pass for one on rows that it never saw.
TEST_F(UserProblems, AFileThatTestsDoesNotTrain) {
  const std::string bytes = "v,tau\n100,1\n-200,2\n";
  write("logs/two.csv", bytes);
  write("copy.csv", bytes);
  const std::string head = "[[problem]]\ntarget = \"tau\"\ninputs = [\"v\"]\n";
  const auto refused = [&](const std::string& files) -> std::string {
    try {
      parse(head + files);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(
      refused("files = [\"logs/one.csv\", \"logs/two.csv\"]\n"
              "split = { file = \"logs/../logs/two.csv\" }\n"),
      AllOf(HasSubstr("g.toml:5"), HasSubstr("two.csv' trains"), HasSubstr("leave it out")));
  EXPECT_THAT(refused("file = \"logs/two.csv\"\nsplit = { file = \"copy.csv\" }\n"),
              HasSubstr("a copy of it tests"));
  EXPECT_THAT(refused("glob = \"logs/t*.csv\"\nsplit = { file = \"logs/two.csv\" }\n"),
              HasSubstr("two.csv' trains"));
  // Of a folder, the others are meant.
  for (const char* test : {"logs/two.csv", "copy.csv"}) {
    const std::string split = "split = { file = \"" + std::string(test) + "\" }\n";
    const std::vector<UserProblem> left = parse(head + "folder = \"logs\"\n" + split);
    ASSERT_EQ(left.size(), 1U);
    EXPECT_EQ(left[0].name, "one");
    EXPECT_EQ(parse(head + "glob = \"logs/*\"\nname = \"all\"\n" + split)[0].files.size(), 1U);
  }
  // Whoever puts a problem together without a text is told when it is made.
  UserProblem own =
      parse(head + "file = \"logs/two.csv\"\nsplit = { file = \"logs/one.csv\" }\n")[0];
  own.held_out.files = own.files;
  EXPECT_THROW(make_user_problem(own, {}, 1), Error);
}

TEST_F(UserProblems, TheLawTheBoxAndTheUnitsAreTheUsers) {
  const Problem problem = make(
      "inputs = [\"v\", \"sgn_v\"]\nlaw = \"2*v\"\nbox = { v = [-40, 50.5] }\n"
      "units = { v = \"m/s\", tau = \"N\" }\n");
  EXPECT_EQ(problem.stages.front().law, "2*v");
  EXPECT_EQ(problem.test.truth, problem.test.target);
  EXPECT_EQ(problem.inputs[0].low, -40);
  EXPECT_EQ(problem.inputs[0].high, 50.5);
  EXPECT_EQ(problem.inputs[0].unit, "m/s");
  EXPECT_EQ(problem.target_unit, "N");
  EXPECT_EQ(problem.inputs[1].sign_of, std::optional<std::size_t>(0));
}

TEST_F(UserProblems, WithoutInputsEveryOtherColumnOfNumbersIsOne) {
  EXPECT_THAT(make("split = { column = \"fold\", values = [\"0\"] }\n").input_names(),
              ElementsAre("v", "load"));
  const Problem in_si = make("roles = \"v=velocity[deg/s]\"\ninputs = [\"v\"]\n");
  EXPECT_NEAR(in_si.inputs[0].low, -30 * 3.14159265358979 / 180, 1e-12);
  EXPECT_EQ(in_si.inputs[0].role, Role::velocity);
}

TEST_F(UserProblems, SeveralFilesAreOneProblemByAName) {
  write("logs/two.csv", "v,load,tau,subject,fold\n1,2,3,z,0\n2,3,4,z,0\n");
  const std::string head = "[[problem]]\ntarget = \"tau\"\ninputs = [\"v\"]\n";
  const std::vector<UserProblem> each = parse(head + "folder = \"logs\"\n");
  ASSERT_EQ(each.size(), 2U);
  EXPECT_EQ(each[0].name, "one");
  EXPECT_EQ(each[1].name, "two");
  const std::vector<UserProblem> together =
      parse(head + "glob = \"logs/*.csv\"\nname = \"both\"\nsplit = { share = 0.5 }\n");
  ASSERT_EQ(together.size(), 1U);
  const Problem problem = make_user_problem(together.front(), {}, 1);
  // Without groups a file is one movement, and held out as a whole.
  EXPECT_TRUE(problem.test.rows() == 2 || problem.test.rows() == 60);
  EXPECT_EQ(problem.stages.front().train.rows() + problem.test.rows(), 62U);
}

TEST_F(UserProblems, TheHashIsTheFilesAndAChangedFileIsRefused) {
  const std::vector<UserProblem> own =
      parse("[[problem]]\nfile = \"logs/one.csv\"\ntarget = \"tau\"\n");
  EXPECT_EQ(own.front().hash(), sha256_of(folder_ / "logs/one.csv").substr(0, 12));
  const std::string before = own.front().hash();
  std::ofstream(folder_ / "logs/one.csv", std::ios::app) << "1,2,3,a,0\n";
  EXPECT_NE(parse("[[problem]]\nfile = \"logs/one.csv\"\ntarget = \"tau\"\n").front().hash(),
            before);
  try {
    make_user_problem(own.front(), {}, 1);
    ADD_FAILURE() << "a changed file was taken";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("one.csv"), HasSubstr("has changed"),
                                    HasSubstr(own.front().files.front().sha256)));
  }
}

// Two recordings of three rows each, cut by a column that names them.
constexpr const char* kRecordings =
    "t,q,v,u,run\n0,0,1,2,up\n0.1,0.1,1,2,up\n0.2,0.2,1,2,up\n"
    "1,0.2,-1,-2,down\n1.1,0.1,-1,-2,down\n1.2,0,-1,-2,down\n";

TEST_F(UserProblems, TheColumnThatIsTheMovementSplitsAndGroups) {
  write("logs/two.csv", kRecordings);
  const std::string head =
      "[[problem]]\nname = \"m\"\nfile = \"logs/two.csv\"\ntarget = \"u\"\ninputs = [\"v\"]\n"
      "roles = \"run=movement\"\n";
  for (const char* group : {"", "group = \"run\"\n"}) {
    const Problem problem = make_user_problem(
        parse(head + group + "split = { column = \"run\", values = [\"down\"] }\n").front(), {}, 1);
    EXPECT_THAT(problem.test.target, ElementsAre(-2, -2, -2));
    EXPECT_THAT(problem.stages.front().train.target, ElementsAre(2, 2, 2));
  }
  const std::string text = head + "split = { column = \"run\", values = [\"left\"] }\n";
  try {
    make_user_problem(parse(text).front(), {}, 1);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("values there: down, up"));
  }
}

TEST_F(UserProblems, MotionIsJudgedOnTheRowsThatTestAndWantsItsColumns) {
  write("logs/two.csv", kRecordings);
  const std::string head =
      "[[problem]]\nname = \"m\"\nfile = \"logs/two.csv\"\ntarget = \"u\"\ninputs = [\"v\"]\n"
      "split = { column = \"run\", values = [\"down\"] }\nmotion = { inertia = 3 }\n";
  const std::string roles =
      "roles = \"run=movement,t=time[ms],q=position[deg],u=motor_torque,v=velocity\"\n";
  const Problem problem = make_user_problem(parse(head + roles).front(), {}, 1);
  ASSERT_TRUE(problem.motion);
  const MotionCase judged = problem.motion();
  EXPECT_EQ(judged.terms.inertia, 3);
  EXPECT_THAT(judged.test.at("u").values, ElementsAre(-2, -2, -2));
  EXPECT_NEAR(judged.test.find(Role::time)->values[1], 1.1e-3, 1e-18);
  EXPECT_NEAR(judged.test.find(Role::position)->values[1], 0.1 * M_PI / 180, 1e-18);
  // Without movements: a column that is the same all through a recording, or another file.
  write("logs/third.csv", std::string(kRecordings) + "\n");
  for (const char* split : {"column = \"run\", values = [\"down\"]", "file = \"logs/third.csv\""}) {
    const Problem other = make_user_problem(
        parse(std::string("[[problem]]\nname = \"m\"\nfile = \"logs/two.csv\"\ntarget = \"u\"\n"
                          "inputs = [\"v\"]\nmotion = {}\nroles = \"t=time,q=position,"
                          "u=motor_torque\"\nsplit = { ") +
              split + " }\n")
            .front(),
        {}, 1);
    ASSERT_TRUE(other.motion);
    EXPECT_EQ(other.motion().test.movement_names.size(), 1U) << split;
  }
  try {
    make(std::string("motion = {}\nroles = \"v=time,load=position,tau=motor_torque\"\n"));
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("held out one by one"));
  }
  try {
    make_user_problem(parse(head + "roles = \"run=movement,t=time,u=motor_torque\"\n").front(), {},
                      1);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("two.csv"), HasSubstr("role position"), HasSubstr("motion")));
  }
}

TEST_F(UserProblems, PrintsAsItReads) {
  write("logs/two.csv", "v,tau\n1,2\n3,4\n");
  const std::vector<UserProblem> own = parse(R"([[problem]]
name = "mine"
files = ["logs/one.csv"]
target = "tau"
inputs = ["v", "load"]
roles = "v=velocity[rpm@motor],load=motor_current[A]"
torque_constant = "0.25@motor"
gear_ratio = 3
where = "fold=1"
drop_missing = true
flip_sign = true
joint = 2
group = "subject"
split = { share = 0.125, seeds = [3, 4] }
law = "v"
units = { v = "rad/s" }
box = { v = [-100, 100] }
motion = { gravity = "sin(q)*5", inertia = 1.5, hold = true, horizon = 0.5 }

[[problem]]
name = "other"
files = ["logs/one.csv"]
target = "tau"
split = { file = "logs/two.csv" }

[[problem]]
name = "third"
files = ["logs/one.csv"]
target = "tau"
split = { column = "fold", values = ["0", "1"] }
motion = {}
)");
  EXPECT_EQ(own[0].motion, (MotionTerms{1.5, "sin(q)*5", true, 0.5}));
  EXPECT_FALSE(own[1].motion);
  EXPECT_EQ(own[2].motion, MotionTerms{});
  for (const UserProblem& one : own) {
    const std::string text = print_user_problem(one);
    const std::vector<UserProblem> again = parse_user_problems(text, "t.toml", {});
    ASSERT_EQ(again.size(), 1U);
    EXPECT_EQ(print_user_problem(again.front()), text);
    EXPECT_EQ(again.front().hash(), one.hash());
  }
}

TEST_F(UserProblems, AMovedTextNamesTheSameFiles) {
  fs::create_directories(folder_ / "deep/er");
  const std::string text = "[[problem]]\nname = \"m\"\nfile = \"logs/one.csv\"\ntarget = \"tau\"\n";
  const std::string moved = moved_grid_text(text, "g.toml", folder_, folder_ / "deep/er");
  const UserProblem own = parse_user_problems(moved, "g.toml", folder_ / "deep/er").front();
  EXPECT_TRUE(fs::equivalent(own.files.front().file, folder_ / "logs/one.csv"));
  EXPECT_EQ(own.files.front().sha256, sha256_of(folder_ / "logs/one.csv"));
}

TEST_F(UserProblems, RefusesWhatCannotBeMeant) {
  EXPECT_THAT(refusal("inputs = [\"w\"]\n"), AllOf(HasSubstr("one.csv"), HasSubstr("'w'")));
  EXPECT_THAT(refusal("inputs = [\"tau\"]\n"), HasSubstr("is the target and an input"));
  EXPECT_THAT(refusal("inputs = []\n"), AllOf(HasSubstr("g.toml:5"), HasSubstr("has no inputs")));
  EXPECT_THAT(refusal("inputs = [\"sgn_tau\"]\n"), HasSubstr("is the sign of the target"));
  EXPECT_THAT(refusal("fold = \"x\"\n"), AllOf(HasSubstr("g.toml:5"), HasSubstr("'fold'")));
  EXPECT_THAT(refusal("folder = \"logs\"\n"), HasSubstr("both name the data"));
  EXPECT_THAT(refusal("split = { share = 2 }\n"), HasSubstr("g.toml:5"));
  EXPECT_THAT(refusal("split = { share = 0.2, column = \"fold\" }\n"), HasSubstr("not by several"));
  EXPECT_THAT(refusal("inputs = [\"v\"]\nsplit = { column = \"fold\", values = [\"9\"] }\n"),
              AllOf(HasSubstr("0 of 60"), HasSubstr("values there: 0, 1, 2")));
  EXPECT_THAT(refusal("inputs = [\"v\"]\ngroup = \"subject\"\n"
                      "split = { column = \"fold\", values = [\"0\"] }\n"),
              HasSubstr("both sides of the split"));
  EXPECT_THAT(refusal("inputs = [\"v\"]\nbox = { v = [-1, 1] }\n"), HasSubstr("in the box"));
  EXPECT_THAT(refusal("inputs = [\"v\"]\nbox = { v = [1] }\n"), HasSubstr("[low, high]"));
  EXPECT_THAT(refusal("inputs = [\"v\"]\nunits = { w = \"m\" }\n"), HasSubstr("'w'"));
  EXPECT_THAT(refusal("roles = \"v=speed\"\n"), HasSubstr("g.toml:5"));
  write("logs/one.csv", "v,tau\n1,2\n2,x\n");
  EXPECT_THAT(refusal("inputs = [\"v\"]\n"), AllOf(HasSubstr("one.csv:3"), HasSubstr("'x'")));
  write("logs/one.csv", "v,exp,tau\n1,2,3\n2,1,4\n");
  EXPECT_THAT(refusal("inputs = [\"exp\"]\n"), HasSubstr("exp_"));
  write("logs/one.csv", "v,tau\n1,1e-200\n2,1e-210\n");
  EXPECT_THAT(refusal("inputs = [\"v\"]\n"), HasSubstr("smaller unit"));
  write("logs/one.csv", "v,tau\n1,1e160\n2,3\n");
  EXPECT_THAT(refusal("inputs = [\"v\"]\n"), HasSubstr("1e160"));
}

TEST(DataFiles, AreFoundInTheOrderOfTheirNames) {
  const fs::path folder = testing::scratch_folder() / "tribench_data_files";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const char* name : {"b.csv", "a.csv", "C.tsv", "notes.md", ".hidden.csv", "z.csv.gz"}) {
    std::ofstream(folder / name) << "x";
  }
  const auto names = [](const std::vector<fs::path>& files) {
    std::vector<std::string> all;
    for (const fs::path& file : files) all.push_back(file.filename().string());
    return all;
  };
  EXPECT_THAT(names(find_data_files(folder, "p")),
              ElementsAre("C.tsv", "a.csv", "b.csv", "z.csv.gz"));
  EXPECT_THAT(names(find_data_files(folder / "?.csv", "p")), ElementsAre("a.csv", "b.csv"));
  EXPECT_THROW(find_data_files(folder / "none*.csv", "p"), Error);
  EXPECT_EQ(name_of_file("logs/joint 1 (up).csv"), "joint_1_up");
  EXPECT_EQ(name_of_file("q.csv.gz"), "q");
  EXPECT_EQ(name_of_file("__.csv"), "data");
  fs::remove_all(folder);
}

// What tells categories apart stays with its row through split and variants, behind the inputs.
TEST_F(UserProblems, ACategoryIsTheLastInputAndToldByItsUnit) {
  const Problem problem = make("category = \"fold\"\ngroup = \"subject\"\n");
  EXPECT_THAT(problem.input_names(), ElementsAre("v", "load", "fold"));
  EXPECT_EQ(problem.inputs.back().unit, kCategoryUnit);
  for (const Table* table : {&problem.stages.front().train, &problem.test}) {
    ASSERT_GT(table->rows(), 0U);
    // Row r of the file has v = r - 30 and fold = r % 3.
    for (std::size_t r = 0; r < table->rows(); ++r) {
      EXPECT_EQ(table->columns[2][r], static_cast<int>(table->columns[0][r] + 30) % 3);
    }
  }
  const Problem named = make("inputs = [\"load\"]\ncategory = \"fold\"\n");
  EXPECT_THAT(named.input_names(), ElementsAre("load", "fold"));
  EXPECT_NE(make("inputs = [\"v\", \"fold\"]\n").inputs.back().unit, kCategoryUnit);
}

TEST_F(UserProblems, ACategoryIsReadBackAsItIsWritten) {
  const std::string text =
      "[[problem]]\nname = \"mine\"\nfile = \"logs/one.csv\"\ntarget = \"tau\"\n"
      "category = \"fold\"\n";
  const UserProblem own = parse(text).front();
  EXPECT_EQ(own.category, "fold");
  EXPECT_EQ(parse(print_user_problem(own)).front().category, "fold");
  EXPECT_THAT(print_user_problem(own), HasSubstr("category"));
}

TEST_F(UserProblems, ACategoryThatIsNoneIsRefusedWithItsMend) {
  EXPECT_THAT(refusal("category = \"fild\"\n"), HasSubstr("fold"));
  EXPECT_THAT(refusal("category = \"subject\"\n"), AllOf(HasSubstr("text"), HasSubstr("number")));
  EXPECT_THAT(refusal("category = \"\"\n"), HasSubstr("empty"));
  EXPECT_THAT(refusal("category = \"v\"\ninputs = [\"v\"]\n"),
              HasSubstr("leave it out of 'inputs'"));
  EXPECT_THAT(refusal("category = \"fold\"\nlaw = \"2*v\"\n"), HasSubstr("'law'"));
  EXPECT_THAT(refusal("category = \"fold\"\nmotion = {}\n"), HasSubstr("'motion'"));
}

}  // namespace
}  // namespace tribench::user
