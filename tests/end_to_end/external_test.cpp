// SPDX-License-Identifier: MIT
//
// Programs as methods: judged like native ones, and a cell of their own is all they can cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

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
    const ProgramRun ended =
        run_to_end({program().string(), "run", (folder_ / "grid.toml").string(), "--out",
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
  EXPECT_THAT(figure("poles", "reason", "paper+safe_div"), HasSubstr("proved free"));
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
