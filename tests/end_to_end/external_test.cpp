// SPDX-License-Identifier: MIT
//
// Programs as methods: judged like native ones, and a cell of their own is all they can cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sanitized.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// A [[external]] entry that runs a line of shell with the request as $1.
std::string shell_method(const std::string& name, const std::string& line) {
  return "[[external]]\nname = \"" + name + "\"\ncommand = [\"bash\", \"-c\", '''" + line +
         "''', \"bash\"]\n";
}

class ExternalTest : public ::testing::Test {
 protected:
  std::string run(const std::string& methods, const std::string& more,
                  const std::string& problem = "A/j2/no_load",
                  const std::string& operators = "paper") {
    write_text(folder_ / "grid.toml", "[grid]\nproblems = [\"" + problem + "\"]\nmethods = [" +
                                          methods + "]\noperators = [\"" + operators +
                                          "\"]\n[budget]\nevaluations = "
                                          "20_000_000\nwall_seconds = 60\nmemory_mib = 1500\n" +
                                          more);
    const ProgramRun ended = run_tribench({"run", (folder_ / "grid.toml").string(), "--out",
                                           (folder_ / "run").string(), "--jobs", "2"});
    EXPECT_EQ(ended.status, 0) << ended.errors;
    return ended.errors;
  }
  std::string reason(const std::string& method) {
    return column_of(folder_ / "run", "reason").at("A/j2/no_load|" + method + "|paper|1");
  }
  std::string figure(const std::string& method, const std::string& column,
                     const std::string& operators = "paper") {
    return column_of(folder_ / "run", column).at("A/j2/no_load|" + method + "|" + operators + "|1");
  }

  TemporaryFolder folder_;
};

TEST_F(ExternalTest, AProgramsFormulasAreJudgedAndItsTraceIsKept) {
  run("\"good\"", shell_method("good", R"sh(cd "$(dirname "$1")"
grep -q '"operator_set": "paper"' "$1" || exit 4
head -1 train.csv | grep -q '^qd,sgn_qd,target,movement$' || exit 5
echo starting up
echo '{"improved": {"train_error": 2.5, "evaluations": 1000}}'
echo '{"front": ["1 + sgn_qd", "13*sgn_qd"], "chosen": 1, "evaluations": 4321, "note": "hello"}')sh"));
  EXPECT_EQ(reason("good"), "");
  EXPECT_EQ(figure("good", "formula"), "13*sgn_qd");
  EXPECT_EQ(figure("good", "evaluations"), "4321");
  EXPECT_EQ(figure("good", "note"), "hello");
  EXPECT_EQ(figure("good", "singularity"), "proved_free");
  EXPECT_THAT(read_text(folder_ / "run" / "trace.csv"), HasSubstr("1000,"));
}

TEST_F(ExternalTest, OnlyProvedFormulasStayWhereTheSetAdmitsNoOthers) {
  run("\"poles\", \"mixed\"",
      shell_method("poles", "echo '{\"front\": [\"1/qd\"]}'") +
          shell_method("mixed",
                       "echo '{\"front\": [\"3\", \"3 + qd/(qd^2 + 1)\", \"1/qd\", "
                       "\"4 + qd\"], \"chosen\": 2}'"),
      "A/j2/no_load", "paper+safe_div");
  EXPECT_EQ(figure("mixed", "formula", "paper+safe_div"), "3 + qd/(qd^2 + 1)");
  EXPECT_EQ(figure("mixed", "note", "paper+safe_div"),
            "its choice 1/qd is not admitted, another formula stands in");
  EXPECT_THAT(figure("poles", "reason", "paper+safe_div"), HasSubstr("is proved free"));
}

TEST_F(ExternalTest, WhatAProgramGetsWrongCostsItsOwnCell) {
  const std::string pid_file = (folder_ / "pid").string();
  run(R"("garbage", "silent", "fails", "cannot", "leaves", "unparsable", "endless", "flood", "linear")",
      shell_method("garbage", "echo hello world") + shell_method("silent", "true") +
          shell_method("fails", "echo no licence >&2; exit 9") +
          shell_method("cannot", "echo '{\"unsupported\": \"needs a load\"}'") +
          shell_method("leaves", "echo '{\"front\": [\"sin(qd)\"]}'") +
          shell_method("unparsable", "echo '{\"front\": [\"2 +* qd\"]}'") +
          shell_method("flood", "yes") +
          shell_method("endless", "echo $$ > " + pid_file + "; sleep 1000 & sleep 1000") +
          "wall_seconds = 1\n");
  EXPECT_EQ(reason("garbage"), "error (the program printed no front but 'hello world')");
  EXPECT_EQ(reason("silent"), "error (the program printed no front)");
  EXPECT_EQ(reason("fails"), "error (the program ended with status 9: no licence)");
  EXPECT_EQ(reason("cannot"), "unsupported (needs a load)");
  EXPECT_THAT(reason("leaves"), HasSubstr("leaves the operator set paper"));
  EXPECT_THAT(reason("unparsable"), HasSubstr("cannot be read"));
  EXPECT_THAT(reason("flood"), HasSubstr("prints without end"));
  EXPECT_EQ(reason("endless"), "timeout");
  EXPECT_EQ(figure("linear", "status", "-"), "ok");
  // What the endless one had started has ended with it.
  const int pid = std::stoi(read_text(pid_file));
  for (int i = 0; i < 500 && is_running(pid); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_FALSE(is_running(pid));
}

TEST_F(ExternalTest, NumbersInAnAnswerAreReadStrictly) {
  const auto front = [](const std::string& more) {
    return "echo '{\"front\": [\"1\", \"2\"], " + more + "}'";
  };
  run(R"("minus", "huge", "half", "good")",
      shell_method("minus", front("\"evaluations\": -5")) +
          shell_method("huge", front("\"chosen\": 1e300")) +
          shell_method("half", front("\"chosen\": 0.5")) +
          shell_method("good", front("\"evaluations\": 1e6, \"chosen\": 0")));
  EXPECT_THAT(reason("minus"), HasSubstr("'evaluations' is -5, not a whole number"));
  EXPECT_THAT(reason("huge"), HasSubstr("'chosen' is 1e+300, not a whole number"));
  EXPECT_THAT(reason("half"), HasSubstr("'chosen' is 0.5, not a whole number"));
  EXPECT_EQ(figure("good", "formula"), "1");
  EXPECT_EQ(figure("good", "evaluations"), "1000000");
}

TEST_F(ExternalTest, AnAnswerHasTheFormThatIsAsked) {
  run(R"("text", "negative", "numbers", "many", "progress", "good")",
      shell_method("text", "echo '{\"front\": \"v\"}'") +
          shell_method("negative",
                       "echo '{\"front\": [\"1\"], \"evaluations\": 18446744073709551615}'") +
          shell_method("numbers", "echo '{\"front\": [1, 2]}'") +
          shell_method("many",
                       "printf '{\"front\": [\"1\"'; for i in $(seq 10000); do printf ',\"'$i'\"'; "
                       "done; echo ']}'") +
          shell_method("progress", "echo '{\"improved\": 3}'; echo '{\"front\": [\"1\"]}'") +
          shell_method("good", "echo '{\"front\": [\"1\"]}'"));
  EXPECT_THAT(reason("text"), HasSubstr("'front' is \"v\", not a list of formulas"));
  EXPECT_THAT(reason("negative"), HasSubstr("'evaluations' is 18446744073709551615, not a whole"));
  EXPECT_THAT(reason("numbers"), HasSubstr("'front' is 1, not text"));
  EXPECT_THAT(reason("many"), HasSubstr("has 10001 formulas, more than 10000"));
  EXPECT_THAT(reason("progress"), HasSubstr("'improved' is 3, not {"));
}

// train.csv has columns of these names already: a program would read one for the other.
TEST_F(ExternalTest, AnInputThatIsCalledLikeAColumnOfTheProtocolIsRefused) {
  const std::string script = (folder_ / "answers.sh").string();
  write_text(script, "echo '{\"front\": [\"3*v\"]}'\n");
  for (const std::string input : {"target", "movement"}) {
    std::string rows = "v," + input + ",tau\n";
    for (int r = 0; r < 8; ++r) {
      rows += std::to_string(r) + "," + std::to_string(r * r) + "," + std::to_string(3 * r) + "\n";
    }
    write_text(folder_ / "own.csv", rows);
    const ProgramRun ended =
        run_tribench({"fit", (folder_ / "own.csv").string(), "--target", "tau", "--inputs",
                      "v," + input, "--external", "bash " + script});
    EXPECT_NE(ended.status, 0) << ended.output;
    EXPECT_THAT(ended.errors, HasSubstr("an input is called '" + input + "'"));
    EXPECT_THAT(ended.errors, HasSubstr("another name"));
  }
}

// Where rows are few, methods of the harness's own leave a part for a look at their choice.
TEST_F(ExternalTest, AProgramIsTheOnlyOneToSpendItsSeconds) {
  std::string rows = "v,tau\n";
  for (int r = 0; r < 40; ++r) rows += std::to_string(r) + "," + std::to_string(3 * r) + "\n";
  write_text(folder_ / "few.csv", rows);
  const std::string told = (folder_ / "told").string();
  const std::string script = (folder_ / "asks.sh").string();
  write_text(script,
             "grep seconds \"$1\" | tr -dc 0-9. > " + told + "\necho '{\"front\": [\"3*v\"]}'\n");
  ASSERT_EQ(run_tribench({"fit", (folder_ / "few.csv").string(), "--target", "tau", "--inputs", "v",
                          "--seconds", "20", "--external", "bash " + script})
                .status,
            0);
  EXPECT_GT(std::stod(read_text(told)), 19);
  for (const std::string spend : {"false", "true"}) {
    write_text(folder_ / "grid.toml",
               "[grid]\nmethods = [\"asks\"]\n[budget]\nseconds = 20\nspend = " + spend +
                   "\n[[problem]]\nfile = \"few.csv\"\ntarget = \"tau\"\n"
                   "[[external]]\nname = \"asks\"\ncommand = [\"bash\", \"" +
                   script + "\"]\n");
    ASSERT_EQ(run_tribench({"run", (folder_ / "grid.toml").string(), "--out",
                            (folder_ / ("spend_" + spend)).string()})
                  .status,
              0);
    EXPECT_GT(std::stod(read_text(told)), 19) << spend;
  }
}

// A program may answer after its seconds: the figures stand, and whoever compares them is told.
TEST_F(ExternalTest, WhatAProgramTakesBeyondItsBudgetIsSaid) {
  const std::string script = (folder_ / "spins.py").string();
  write_text(script, "import time\nwhile time.process_time() < 1.5:\n  pass\n");
  run("\"slow\", \"boasts\", \"within\"",
      shell_method("slow",
                   "python3 " + script + "; echo '{\"front\": [\"3\"], \"note\": \"mine\"}'") +
          "seconds = 0.3\nwall_seconds = 60\ncpu_limit_seconds = 60\n" +
          shell_method("boasts", "echo '{\"front\": [\"3\"], \"evaluations\": 30000000}'") +
          shell_method("within", "echo '{\"front\": [\"3\"], \"evaluations\": 20000000}'"));
  EXPECT_THAT(figure("slow", "note"), StartsWith("mine; over budget: "));
  EXPECT_THAT(figure("slow", "note"), HasSubstr(" of 0.3 CPU seconds"));
  EXPECT_EQ(figure("boasts", "note"), "over budget: 30000000 of 20000000 evaluations");
  EXPECT_EQ(figure("within", "note"), "");
}

TEST_F(ExternalTest, AnAnswerSaysOneThingInKnownWords) {
  run(R"("misspelt", "both", "indented", "logs")",
      shell_method("misspelt", "echo '{\"front\": [\"1\", \"2\"], \"choosen\": 0}'") +
          shell_method("both", "echo '{\"front\": [\"1\"], \"unsupported\": \"no\"}'") +
          shell_method("indented", "printf '  \\t{\"front\": [\"1\"]}'") +
          shell_method("logs", "echo '{\"level\": \"info\"}'; echo '{\"front\": [\"1\"]}'"));
  EXPECT_THAT(reason("misspelt"), HasSubstr("'choosen' that is not known; did you mean chosen?"));
  EXPECT_THAT(reason("both"), HasSubstr("a front and says that it is unsupported"));
  EXPECT_EQ(reason("indented"), "");
  EXPECT_EQ(reason("logs"), "");
}

TEST_F(ExternalTest, AProgramsMemoryIsItsCells) {
  if (kIsSanitized) GTEST_SKIP() << kNothingToMeasure;
  run("\"large\", \"small\"", shell_method("large",
                                           "x=$(head -c 60000000 /dev/zero | tr \"\\0\" x); "
                                           "echo '{\"front\": [\"3\"]}'") +
                                  shell_method("small", "echo '{\"front\": [\"3\"]}'"));
  EXPECT_GT(std::stod(figure("large", "peak_memory_mib")), 55);
  EXPECT_LT(std::stod(figure("small", "peak_memory_mib")), 55);
}

// A limit of memory shows to a program as a request that is refused.
TEST_F(ExternalTest, AProgramThatIsRefusedMemoryHasMetItsLimit) {
  run("\"python\", \"aborts\", \"other\", \"linear\"",
      shell_method("python", "python3 -c 'x = bytearray(1 << 33)'") +
          shell_method("aborts", "echo \"  what():  std::bad_alloc\" >&2; kill -ABRT $$") +
          shell_method("other", "echo no memory of that file >&2; exit 1"));
  EXPECT_EQ(reason("python"), "out_of_memory");
  EXPECT_EQ(reason("aborts"), "out_of_memory");
  EXPECT_THAT(reason("other"), HasSubstr("error (the program ended with status 1"));
  EXPECT_EQ(figure("linear", "status", "-"), "ok");
}

TEST_F(ExternalTest, AnAnswerStandsThoughSomethingStillHoldsTheOutput) {
  run("\"lingers\"", shell_method("lingers",
                                  "setsid -f sleep 987; sleep 987 & "
                                  "echo '{\"front\": [\"3\"]}'; exit 0"));
  EXPECT_EQ(reason("lingers"), "");
  EXPECT_EQ(figure("lingers", "formula"), "3");
}

TEST_F(ExternalTest, APriorHoldsForProgramsAndIsToldThem) {
  run("\"powers\"",
      shell_method("powers", R"sh(grep -q '"max_degree": 1' "$1" || exit 4
echo '{"front": ["1 + g", "2 + g^2", "3 + g*qd*g"], "chosen": 2}')sh") +
          "[prior]\nmax_degree = { g = 1 }\n",
      "A/j2/load");
  const auto formulas = column_of(folder_ / "run", "formula");
  EXPECT_EQ(formulas.at("A/j2/load|powers|paper|1"), "1 + g");
}

// A limit on files, a full disk: no result, and the run says so.
TEST_F(ExternalTest, AFaultOfTheMachineStopsTheRunAndIsRepeatedByResume) {
  const std::string flag = (folder_ / "mended").string();
  write_text(folder_ / "grid.toml",
             "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"limited\"]\n" +
                 shell_method("limited", "test -e " + flag +
                                             " || kill -XFSZ $$; echo '{\"front\": [\"4\"]}'"));
  std::vector<std::string> command = {program().string(), "run", (folder_ / "grid.toml").string(),
                                      "--out", (folder_ / "run").string()};
  const ProgramRun stopped = run_to_end(command);
  EXPECT_EQ(stopped.status, 3);
  EXPECT_THAT(stopped.errors, HasSubstr("ulimit -f unlimited"));
  command.push_back("--resume");
  // No folder for temporary files is such a fault too.
  const ProgramRun homeless = run_to_end(command, {"TMPDIR=/no/such/folder"});
  EXPECT_EQ(homeless.status, 3);
  EXPECT_THAT(homeless.errors, HasSubstr("TMPDIR"));
  write_text(flag, "");
  EXPECT_EQ(run_to_end(command).status, 0);
  EXPECT_EQ(figure("limited", "formula"), "4");
}

// The program's own folder is gone by then, and there is room again.
TEST_F(ExternalTest, ADiskThatIsFullWithinAProgramStopsTheRun) {
  for (const std::string fault : {"dd if=/dev/zero of=/dev/full count=1 || exit 1",
                                  "(ulimit -f 1; yes > $TMPDIR/x) || exit 1"}) {
    write_text(folder_ / "grid.toml",
               "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"filler\"]\n" +
                   shell_method("filler", fault + "; echo '{\"front\": [\"4\"]}'"));
    const ProgramRun stopped =
        run_to_end({program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                    (folder_ / std::to_string(fault.size())).string()});
    EXPECT_EQ(stopped.status, 3) << fault;
    EXPECT_THAT(stopped.errors, HasSubstr("no room to write")) << fault;
  }
}

// Figures of two versions of a program in one leaderboard would be nobody's.
TEST_F(ExternalTest, AProgramThatHasChangedIsAnotherRun) {
  const std::filesystem::path script = folder_ / "theirs.sh";
  const auto write_version = [&](const std::string& number) {
    write_text(script, "echo '{\"front\": [\"" + number + "\"]}'\n");
  };
  write_version("3");
  write_text(
      folder_ / "grid.toml",
      "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"theirs\"]\nseeds = { count = 2 }\n"
      "[[external]]\nname = \"theirs\"\ncommand = [\"bash\", \"" +
          script.string() + "\"]\n");
  const auto run_to = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", (folder_ / "grid.toml").string(), "--out",
                                      (folder_ / out).string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_tribench(words);
  };
  ASSERT_EQ(run_to("one", {"--shard", "1/2"}).status, 0);
  ASSERT_EQ(run_to("one", {"--shard", "1/2", "--resume"}).status, 0);
  EXPECT_THAT(read_text(folder_ / "one" / "provenance.json"), HasSubstr("theirs.sh\": \""));
  write_version("4");
  const ProgramRun resumed = run_to("one", {"--resume"});
  EXPECT_EQ(resumed.status, 2);
  EXPECT_THAT(resumed.errors,
              HasSubstr("the program's file differs, theirs: " + script.string() + ": "));
  ASSERT_EQ(run_to("two", {"--shard", "2/2"}).status, 0);
  const ProgramRun merged =
      run_tribench({"merge", (folder_ / "one").string(), (folder_ / "two").string(), "--out",
                    (folder_ / "merged").string()});
  EXPECT_EQ(merged.status, 2);
  EXPECT_THAT(merged.errors, HasSubstr("theirs.sh: "));
}

TEST_F(ExternalTest, ARunOfWhichEveryCellFailedHasFailed) {
  write_text(folder_ / "grid.toml", "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"no\"]\n" +
                                        shell_method("no", "exit 9"));
  const ProgramRun ended =
      run_tribench({"run", (folder_ / "grid.toml").string(), "--out", (folder_ / "run").string()});
  EXPECT_EQ(ended.status, 3);
  EXPECT_THAT(ended.errors, HasSubstr("every cell failed, the first one by: error (the program"));
}

TEST_F(ExternalTest, TheTemplateRunsAsItStands) {
  const std::string script = (source_dir() / "adapters" / "template.py").string();
  run("\"template\"",
      "[[external]]\nname = \"template\"\ncommand = [\"python3\", \"" + script + "\"]\n");
  EXPECT_EQ(reason("template"), "");
  EXPECT_THAT(figure("template", "formula"), HasSubstr("*qd"));
}

// Must-show of the harness: SciPy's basin hopping and the native baseline on the same data, in one
// leaderboard, at the same optimum where both converge.
TEST_F(ExternalTest, SciPyAndTheNativeBaselineFindTheSameOptimum) {
  if (run_to_end({"/usr/bin/python3", "-c", "import scipy.optimize"}).status != 0) {
    GTEST_SKIP() << "python3-scipy is not installed (./tribench test installs it)";
  }
  const std::string script = (source_dir() / "adapters" / "scipy_basinhopping.py").string();
  run(R"("scipy_symmetric", "printed")",
      "[[method]]\nname = \"printed\"\nalgorithm = \"symmetric\"\nparameters = { form = "
      "\"as_printed\" }\n[[external]]\nname = \"scipy_symmetric\"\nfixed_form = true\n"
      "parameters = { model = \"symmetric\", hops = 30 }\ncommand = [\"/usr/bin/python3\", \"" +
          script + "\"]\n");
  ASSERT_EQ(figure("scipy_symmetric", "status", "-"), "ok")
      << figure("scipy_symmetric", "reason", "-");
  const double scipy = std::stod(figure("scipy_symmetric", "mae_train", "-"));
  const double native = std::stod(figure("printed", "mae_train", "-"));
  EXPECT_NEAR(scipy, native, 0.01 * native);
  EXPECT_THAT(read_text(folder_ / "run" / "leaderboard.md"), HasSubstr("scipy_symmetric"));
}

}  // namespace
}  // namespace tribench::testing
