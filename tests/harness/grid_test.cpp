// SPDX-License-Identifier: MIT
#include "harness/grid.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "harness/data_grid.hpp"
#include "harness/run_files.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::unique_ptr<Regressor> make_nothing(const Parameters&, const MakeMethod&) { return nullptr; }

Registry small_registry() {
  Registry registry;
  registry.add({"grid_alpha",
                "searches",
                {{"islands", "how many", std::int64_t{4}, 1, 100, {}}},
                false,
                make_nothing});
  registry.add({"grid_fixed", "a fixed form", {}, true, make_nothing});
  return registry;
}

Grid parse_text(const std::string& toml) {
  return parse_grid(toml, "g.toml", small_registry(), Catalogue());
}

std::string refusal(const std::string& toml) {
  try {
    parse_text(toml);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "accepted";
}

constexpr const char* kAxes =
    "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"grid_alpha\", \"grid_fixed\"]\n";

// A grid names a file of published figures beside itself; a run's folder holds a copy.
TEST(Grid, TakesPublishedFiguresAlongIntoTheRunsFolder) {
  const std::filesystem::path folder = testing::scratch_folder() / "tribench_grid_reference";
  std::filesystem::create_directories(folder / "run");
  const std::string figures =
      "table,problem,published_method,kind,methods,mae,complexity,note\n"
      "T1,A/j2/no_load,SR,symbolic,grid_alpha,0.04,15,\n";
  write_file(folder / "published.csv", figures);
  const std::string toml = std::string(kAxes) + "reference = \"published.csv\"\n";
  write_file(folder / "g.toml", toml);
  const Grid grid = load_grid(folder / "g.toml", small_registry(), Catalogue());
  EXPECT_EQ(grid.reference, figures);
  write_plan_files(folder / "run", grid);
  const Grid again = load_grid(folder / "run/grid.toml", small_registry(), Catalogue());
  EXPECT_EQ(again.reference, figures);
  EXPECT_EQ(print_grid(again), print_grid(grid));
  const auto said = [&]() -> std::string {
    try {
      load_grid(folder / "g.toml", small_registry(), Catalogue());
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  write_file(folder / "published.csv", "table\n");
  EXPECT_THAT(said(), AllOf(HasSubstr("g.toml:4:13: "), HasSubstr("published.csv: column")));
  write_file(folder / "published.csv",
             figures + "T1,A/j2/no_load,SR,symbolic,grid_alpha,low,15,\n");
  EXPECT_THAT(said(), AllOf(HasSubstr("g.toml:4:13: "), HasSubstr("line 3: 'low' in column mae")));
  std::filesystem::remove(folder / "published.csv");
  EXPECT_THAT(said(), AllOf(HasSubstr("g.toml:4:13: "), HasSubstr("published.csv")));
  std::filesystem::remove_all(folder);
}

TEST(Grid, CrossesProblemsMethodsSetsAndSeedsAndRunsFixedFormsOnce) {
  const Grid grid = parse_text(R"([grid]
problems = ["A/j?/no_load"]
methods = ["grid_*"]
operators = ["paper", "paper+div"]
seeds = { first = 5, count = 2 }
)");
  std::vector<std::string> keys;
  for (const Cell& cell : grid.cells()) keys.push_back(cell.key());
  EXPECT_THAT(
      keys,
      ElementsAre("A/j2/no_load|grid_alpha|paper|5", "A/j2/no_load|grid_alpha|paper|6",
                  "A/j2/no_load|grid_alpha|paper+div|5", "A/j2/no_load|grid_alpha|paper+div|6",
                  "A/j2/no_load|grid_fixed|-|5", "A/j2/no_load|grid_fixed|-|6",
                  "A/j4/no_load|grid_alpha|paper|5", "A/j4/no_load|grid_alpha|paper|6",
                  "A/j4/no_load|grid_alpha|paper+div|5", "A/j4/no_load|grid_alpha|paper+div|6",
                  "A/j4/no_load|grid_fixed|-|5", "A/j4/no_load|grid_fixed|-|6"));
}

TEST(Grid, RefusesUnknownKeysWithTheNearestNameAndTheLine) {
  EXPECT_THAT(refusal(std::string(kAxes) + "sedes = 3\n"),
              AllOf(HasSubstr("g.toml:4:1"), HasSubstr("unknown key 'sedes' in [grid]"),
                    HasSubstr("did you mean seeds?")));
  EXPECT_THAT(refusal(std::string(kAxes) + "[budget]\nevaluation = 3\n"),
              AllOf(HasSubstr("g.toml:5:1"), HasSubstr("did you mean evaluations?")));
  EXPECT_THAT(refusal(std::string(kAxes) + "[buget]\nseconds = 3\n"),
              HasSubstr("did you mean budget?"));
  EXPECT_THAT(refusal(std::string(kAxes) + "[[method]]\nname = \"x\"\nalgoritm = \"y\"\n"),
              HasSubstr("did you mean algorithm?"));
  EXPECT_THAT(refusal(std::string(kAxes) + "seeds = { frist = 1 }\n"),
              HasSubstr("did you mean first?"));
}

TEST(Grid, RefusesUnknownNamesAndValuesOfAnotherKind) {
  EXPECT_THAT(refusal("[grid]\nproblems = [\"A/j2/noload\"]\nmethods = [\"*\"]\n"),
              AllOf(HasSubstr("g.toml:2"), HasSubstr("did you mean A/j2/no_load?")));
  EXPECT_THAT(refusal("[grid]\nproblems = [\"A/*\"]\nmethods = [\"grid_alpa\"]\n"),
              HasSubstr("did you mean grid_alpha?"));
  EXPECT_THAT(refusal(std::string(kAxes) + "seeds = { first = -1 }\n"),
              HasSubstr("must be a whole number, not negative"));
  EXPECT_THAT(refusal(std::string(kAxes) + "seeds = { count = 0 }\n"),
              HasSubstr("use 1 to 1000000"));
  EXPECT_THAT(refusal(std::string(kAxes) + "seeds = { count = 1e9 }\n"),
              HasSubstr("use 1 to 1000000"));
  EXPECT_THAT(refusal(std::string(kAxes) + "[budget]\nmemory_mib = \"much\"\n"),
              HasSubstr("must be a number"));
  EXPECT_THAT(refusal("[grid\n"), HasSubstr("g.toml:1"));
  EXPECT_THAT(refusal("[grid]\nmethods = [\"*\"]\n"), HasSubstr("'problems' is missing"));
  EXPECT_THAT(refusal(std::string(kAxes) + "[problem]\nname = \"x\"\n"),
              HasSubstr("'problem' in the file must be written as [[problem]]"));
}

// What a table declares and no list names would not run, without a word.
TEST(Grid, RefusesATableThatNoListNames) {
  const std::string method = "[[method]]\nname = \"many\"\nalgorithm = \"grid_alpha\"\n";
  EXPECT_THAT(refusal(kAxes + method),
              AllOf(HasSubstr("g.toml:4:1"), HasSubstr("the method 'many' would not run"),
                    HasSubstr("add \"many\" to 'methods'")));
  EXPECT_THAT(refusal(std::string(kAxes) + "[[external]]\nname = \"many\"\ncommand = [\"true\"]\n"),
              HasSubstr("g.toml:4:1: the method 'many' would not run"));
  EXPECT_THAT(
      refusal(std::string(kAxes) + "[[operator_set]]\nname = \"mine\"\noperators = [\"+\"]\n"),
      HasSubstr("g.toml:4:1: the operator set 'mine' would not run"));
  EXPECT_EQ(
      refusal("[grid]\nproblems = [\"A/j2/load\"]\nmethods = [\"grid_*\", \"!many\"]\n" + method),
      "accepted");

  const std::filesystem::path folder = testing::scratch_folder() / "tribench_grid_unnamed";
  std::filesystem::create_directories(folder / "logs");
  for (const char* name : {"a.csv", "b.csv"}) write_file(folder / "logs" / name, "x,y\n1,2\n3,4\n");
  const std::string problem =
      fmt::format("[[problem]]\ntarget = \"y\"\nfolder = \"{}\"\n", (folder / "logs").string());
  EXPECT_THAT(refusal(kAxes + problem),
              AllOf(HasSubstr("g.toml:4:1"), HasSubstr("the problem 'a' would not run")));
  // Of a table that is a problem a file, one of them is enough.
  EXPECT_EQ(refusal("[grid]\nproblems = [\"b~noise=1\"]\nmethods = [\"grid_*\"]\n" + problem),
            "accepted");
  std::filesystem::remove_all(folder);
}

TEST(Grid, RefusesTwoTablesOfOneName) {
  const std::string method = "[[method]]\nname = \"many\"\nalgorithm = \"grid_alpha\"\n";
  EXPECT_THAT(refusal(kAxes + method + method),
              AllOf(HasSubstr("g.toml:8:8"), HasSubstr("two methods are called 'many'")));
  const std::string set = "[[operator_set]]\nname = \"paper\"\noperators = [\"+\"]\n";
  EXPECT_THAT(refusal(kAxes + set),
              AllOf(HasSubstr("g.toml:5:8"), HasSubstr("'paper' is the name of a set")));
}

TEST(Grid, RefusesALawOfASuiteThatCannotBeRead) {
  const std::filesystem::path data = testing::scratch_folder() / "tribench_grid_laws";
  std::filesystem::create_directories(data / "suites");
  write_file(data / "suites/own.toml",
             "[suite]\nname = \"own\"\nrows = 9\ntest_rows = 9\n"
             "[[problem]]\nname = \"good\"\nlaw = \"2*x\"\ninputs = [{ name = \"x\", low = 0, high "
             "= 1 }]\n"
             "[[problem]]\nname = \"bad\"\nlaw = \"2*z\"\ninputs = [{ name = \"x\", low = 0, high "
             "= 1 }]\n");
  const auto said = [&](const std::string& problem) -> std::string {
    try {
      parse_grid("[grid]\nproblems = [\"own/" + problem + "\"]\nmethods = [\"grid_alpha\"]\n",
                 "g.toml", small_registry(), Catalogue(data));
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(said("good"), "accepted");
  EXPECT_THAT(said("bad~noise=1"),
              AllOf(HasSubstr("own.toml:11:7"), HasSubstr("'z' is not an input")));
  std::filesystem::remove_all(data);
}

// Before anything runs: a cell would say it, when it is too late.
TEST(Grid, AProblemsTableIsHeldAgainstItsColumns) {
  const std::filesystem::path folder = testing::scratch_folder() / "tribench_grid_columns";
  std::filesystem::create_directories(folder);
  write_file(folder / "a.csv", "x,z,y\n1,2,3\n3,4,5\n");
  const auto said = [&](const std::string& more) -> std::string {
    const Grid grid = parse_text(
        fmt::format(
            "[grid]\nmethods = [\"grid_alpha\"]\n[[problem]]\ntarget = \"y\"\nfile = \"{}\"\n",
            (folder / "a.csv").string()) +
        more);
    try {
      reading_notes(grid);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(said("units = {}\n[[problem]]\ntarget = \"w\"\nname = \"other\"\nfile = \"" +
                   (folder / "a.csv").string() + "\"\n"),
              AllOf(HasSubstr("g.toml:7:1: "), HasSubstr("there is no column 'w'")));
  EXPECT_EQ(said("law = \"2*x + z\"\nunits = { x = \"m\", y = \"N\" }\n"), "accepted");
  EXPECT_THAT(said("law = \"2*w\"\n"),
              AllOf(HasSubstr("g.toml:3:1: "), HasSubstr("'w' is not an input")));
  EXPECT_THAT(said("units = { w = \"m\" }\n"), AllOf(HasSubstr("g.toml:3:1: "), HasSubstr("'w'")));
  EXPECT_THAT(said("box = { w = [0, 9] }\n"), AllOf(HasSubstr("g.toml:3:1: "), HasSubstr("'w'")));
  EXPECT_THAT(said("inputs = [\"w\"]\n"), AllOf(HasSubstr("g.toml:3:1: "), HasSubstr("'w'")));
  std::filesystem::remove_all(folder);
}

TEST(Grid, RefusesToRunNothing) {
  EXPECT_THAT(refusal("[grid]\nproblems = []\nmethods = [\"*\"]\n"), HasSubstr("no cell"));
  EXPECT_THAT(refusal("[grid]\nproblems = [\"A/*\"]\nmethods = []\n"), HasSubstr("no cell"));
}

TEST(Grid, RefusesToShowOneAlgorithmUnderTheNameOfAnother) {
  const std::string text = std::string(kAxes) + "[[method]]\nname = \"grid_fixed\"\n";
  EXPECT_THAT(refusal(text + "algorithm = \"grid_alpha\"\n"),
              AllOf(HasSubstr("g.toml:5"), HasSubstr("another algorithm than 'grid_alpha'")));
}

TEST(Grid, RefusesAProgramUnderTheNameOfAnAlgorithm) {
  EXPECT_THAT(
      refusal(std::string(kAxes) + "[[external]]\nname = \"grid_fixed\"\ncommand = [\"true\"]\n"),
      AllOf(HasSubstr("g.toml:5"), HasSubstr("'grid_fixed' is the name of an algorithm"),
            HasSubstr("rename it")));
}

// What should not run would run, without a word.
TEST(Grid, RefusesAQuarantineThatLeavesOutNoCell) {
  const auto with = [](const std::string& globs) {
    return refusal(std::string(kAxes) + "quarantine = [" + globs + "]\n");
  };
  EXPECT_EQ(with(""), "accepted");
  EXPECT_EQ(with("\"*|grid_fixed|*\""), "accepted");
  EXPECT_THAT(
      with("\"*|grid_fixed|*\", \"A/j3/*|grid_alpha|*\""),
      AllOf(HasSubstr("g.toml:4"), HasSubstr("no cell of the grid is 'A/j3/*|grid_alpha|*'"),
            HasSubstr("A/j2/no_load|grid_alpha|paper|1")));
}

// The list may be another run's, of which this grid has some cells; the run's folder keeps those.
TEST(Grid, PrintsTheQuarantineThatTakesEffect) {
  Grid grid = parse_text(kAxes);
  grid.quarantine = {"*|grid_fixed|*", "*|gone|*"};
  EXPECT_THAT(grid.idle_quarantine(), ElementsAre("*|gone|*"));
  EXPECT_THAT(parse_text(print_grid(grid)).quarantine, ElementsAre("*|grid_fixed|*"));
}

TEST(Grid, AQuarantineNeedNotKnowWhatFilesHashTo) {
  Grid grid;
  grid.quarantine = {"tt|linear|*"};
  const Cell hashed{"tt", "linear", "-", 1, "3fa9c1e2d4b5"};
  EXPECT_TRUE(grid.quarantined(hashed));
  EXPECT_FALSE(grid.quarantined({"tt", "constant", "-", 1, "3fa9c1e2d4b5"}));
  grid.quarantine = {"tt@3fa9c1e2d4b5|linear|-|1"};
  EXPECT_TRUE(grid.quarantined(hashed));
  EXPECT_FALSE(grid.quarantined({"tt", "linear", "-", 1, "000000000000"}));
}

TEST(Grid, ChecksParametersAgainstTheAlgorithm) {
  EXPECT_THAT(refusal(std::string(kAxes) + "[[method]]\nname = \"a2\"\nalgorithm = \"grid_alpha\"\n"
                                           "parameters = { island = 3 }\n"),
              AllOf(HasSubstr("g.toml:7"), HasSubstr("method 'grid_alpha'"),
                    HasSubstr("did you mean islands?")));
  EXPECT_THAT(refusal(std::string(kAxes) + "[[method]]\nname = \"a2\"\nalgorithm = \"grid_alpha\"\n"
                                           "parameters = { islands = 300 }\n"),
              HasSubstr("out of range"));
}

// What a name may do where it is not refused: begin a formula of a spreadsheet, leave the folder,
// open a tag of a page.
TEST(Grid, RefusesNamesThatFilesPagesAndShellsMisread) {
  for (const char* name :
       {"=cmd|' /C calc'!A0", "x/../../../Y", "<b>x</b>", "two words", "a\\u0001b"}) {
    const std::string quoted = std::string("name = \"") + name + "\"\n";
    EXPECT_THAT(refusal(std::string(kAxes) + quoted), HasSubstr("cannot name a grid; use 1 to 64"));
    EXPECT_THAT(refusal(std::string(kAxes) + "[[method]]\nalgorithm = \"grid_alpha\"\n" + quoted),
                HasSubstr("cannot name a method"));
    EXPECT_THAT(refusal(std::string(kAxes) + "[[operator_set]]\noperators = [\"+\"]\n" + quoted),
                HasSubstr("cannot name an operator set"));
  }
}

TEST(Grid, RefusesMoreCellsThanARunCanHold) {
  EXPECT_THAT(refusal("[grid]\nproblems = [\"A/*\"]\nmethods = [\"grid_*\"]\n"
                      "seeds = { count = 1e6 }\n"),
              HasSubstr("split it"));
}

TEST(Grid, ReadsAPriorAndHandsItToTheProblemsInputs) {
  const std::string axes =
      "[grid]\nproblems = [\"A/j2/*load\"]\nmethods = [\"grid_alpha\"]\n[prior]\nmax_degree = ";
  const Grid grid = parse_text(axes + "{ g = 1 }\n");
  EXPECT_EQ(grid.prior.max_degree.at("g"), 1);
  EXPECT_EQ(parse_text(print_grid(grid)).prior, grid.prior);
  Problem problem = Catalogue().find("A/j2/load").make(1);
  apply_prior(grid.prior, problem);
  for (const Input& input : problem.inputs) {
    EXPECT_EQ(input.max_degree, input.name == "g" ? 1 : 0) << input.name;
  }
  EXPECT_THAT(refusal(axes + "{ g = 0 }\n"), HasSubstr("no whole number from 1 to 16"));
  EXPECT_THAT(refusal(axes + "{ g = 1, sgn_qdd = 2 }\n"),
              AllOf(HasSubstr("g.toml:5:14"), HasSubstr("'sgn_qdd' is an input of no problem"),
                    HasSubstr("did you mean sgn_qd?")));
}

TEST(Grid, AnExclamationMarkLeavesOutOfWhatStandsBefore) {
  const std::vector<std::string> known = {"pysr", "parfam", "relay", "udsr"};
  const auto picked = [&](const std::vector<std::string>& globs) {
    return pick_names(globs, known, "method", "g.toml");
  };
  EXPECT_THAT(picked({"*", "!relay"}), ElementsAre("pysr", "parfam", "udsr"));
  EXPECT_THAT(picked({"*", "!p*", "parfam"}), ElementsAre("parfam", "relay", "udsr"));
  EXPECT_THROW(picked({"*", "!rely"}), Error);
  EXPECT_THROW(picked({"!relay"}), Error);
}

TEST(Grid, PrintedItReadsBackToTheSameGrid) {
  const std::string toml = R"([grid]
name = "all-of-it"
problems = ["A/*"]
methods = ["grid_alpha", "many", "theirs"]
operators = ["paper", "mine"]
seeds = { first = 3, count = 7 }
quarantine = ["*|many|*"]
[budget]
evaluations = 1e7
seconds = 4
memory_mib = 300
spend = true
[retry]
crashed = 2
[[method]]
name = "many"
algorithm = "grid_alpha"
parameters = { islands = 32 }
[[external]]
name = "theirs"
command = ["python3", "theirs.py"]
operators = ["paper"]
wall_seconds = 9
[[operator_set]]
name = "mine"
operators = ["+", "*", "tanh"]
)";
  const Grid grid = parse_text(toml);
  const Grid again = parse_text(print_grid(grid));
  EXPECT_EQ(print_grid(again), print_grid(grid));
  EXPECT_EQ(again.cells(), grid.cells());
  EXPECT_EQ(again.limits, grid.limits);
  EXPECT_EQ(again.limits_of(again.method("theirs")).wall_seconds, 9);
  EXPECT_EQ(again.limits_of(again.method("many")).memory_mib, 300);
  EXPECT_TRUE(again.limits_of(again.method("many")).spend);
  EXPECT_TRUE(again.operator_set("mine").allows(Op::tanh));
  EXPECT_FALSE(again.operator_set("mine").allows(Op::exp));
  EXPECT_EQ(again.retry.crashed, 2);
}

TEST(Grid, SecondsThatAreToBeSpentAreNotEndedByEvaluationsThatNobodyNamed) {
  const auto evaluations = [](const std::string& budget) {
    const Grid grid = parse_text(
        "[grid]\nname = \"g\"\nproblems = [\"A/*\"]\nmethods = "
        "[\"grid_alpha\"]\noperators = [\"paper\"]\n[budget]\n" +
        budget);
    EXPECT_EQ(parse_text(print_grid(grid)).limits, grid.limits);
    return grid.limits.evaluations;
  };
  EXPECT_EQ(evaluations("seconds = 30\nspend = true\n"), CellLimits::kAmple);
  EXPECT_EQ(evaluations("seconds = 30\n"), CellLimits().evaluations);
  EXPECT_EQ(evaluations("seconds = 30\nspend = true\nevaluations = 1e7\n"), 10'000'000U);
  EXPECT_EQ(evaluations("spend = true\n"), CellLimits().evaluations);
}

TEST(Grid, ANewCellKeyIsANewStream) {
  std::set<std::string> keys;
  for (const Cell& cell : parse_text(std::string(kAxes) + "operators = [\"*\"]\n").cells()) {
    EXPECT_TRUE(keys.insert(cell.key()).second) << cell.key();
  }
}

TEST(Grid, ASweepMultipliesProblemsAndMethods) {
  const Grid grid = parse_text(R"([grid]
problems = ["A/j2/no_load"]
methods = ["grid_alpha", "grid_fixed"]
sweep = { noise = [0, 0.1], rows = [20], "grid_alpha.islands" = [2, 8] }
)");
  EXPECT_THAT(grid.problems,
              ElementsAre("A/j2/no_load~noise=0~rows=20", "A/j2/no_load~noise=0.1~rows=20"));
  std::vector<std::string> methods;
  for (const Method& method : grid.methods) methods.push_back(method.name);
  EXPECT_THAT(methods, ElementsAre("grid_alpha-islands-2", "grid_alpha-islands-8", "grid_fixed"));
  EXPECT_EQ(std::get<std::int64_t>(grid.methods[1].parameters.at("islands")), 8);
  const Grid again = parse_text(print_grid(grid));
  EXPECT_EQ(print_grid(again), print_grid(grid));
  EXPECT_EQ(again.cells(), grid.cells());
}

TEST(Grid, RefusesASweepOfWhatIsNotThere) {
  const auto swept = [](const std::string& sweep) {
    return refusal(std::string(kAxes) + "sweep = { " + sweep + " }\n");
  };
  EXPECT_THAT(swept("nosie = [1]"), AllOf(HasSubstr("g.toml:4"), HasSubstr("METHOD.PARAMETER")));
  EXPECT_THAT(swept("noise = []"), HasSubstr("g.toml:4"));
  EXPECT_THAT(swept("noise = [0, -1]"),
              AllOf(HasSubstr("g.toml:4:19: '~noise=-1'"), HasSubstr("from 0 to 1000")));
  EXPECT_THAT(swept("rows = [0]"), AllOf(HasSubstr("g.toml:4:18"), HasSubstr("from 1 to")));
  EXPECT_THAT(swept("\"grid_alpha.island\" = [1]"), HasSubstr("islands"));
  EXPECT_THAT(swept("\"grid_alpha.islands\" = [1000]"), HasSubstr("g.toml:4"));
  EXPECT_THAT(swept("\"pysr.populations\" = [8]"), HasSubstr("does not run it"));
  // More than a run can hold, before they are made.
  std::string many = "0";
  for (int i = 1; i < 1001; ++i) many += fmt::format(", {}", i);
  EXPECT_THAT(swept(fmt::format("noise = [{0}], rows = [{0}]", many)),
              AllOf(HasSubstr("g.toml:4"), HasSubstr("sweep fewer values")));
  EXPECT_THAT(swept(fmt::format("\"grid_alpha.a\" = [{0}], \"grid_alpha.b\" = [{0}]", many)),
              AllOf(HasSubstr("g.toml:4"), HasSubstr("sweep fewer values")));
  // A method whose name begins with it is another one.
  EXPECT_THAT(refusal("[grid]\nproblems = [\"A/j2/load\"]\nmethods = [\"pysr-x\"]\n"
                      "sweep = { \"pysr.cycles\" = [5] }\n[[method]]\nname = \"pysr-x\"\n"
                      "algorithm = \"pysr\"\nparameters = { cycles = 7 }\n"),
              HasSubstr("does not run it"));
}

}  // namespace
}  // namespace tribench
