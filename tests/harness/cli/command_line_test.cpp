// SPDX-License-Identifier: MIT
//
// What every subcommand's line must keep to: numbers are read strictly, unknown words are answered
// with the nearest known one. Subcommands and options are taken from the program's own help, so
// that none is forgotten.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "foundation/child_process.hpp"
#include "harness/cli/program.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sanitized.hpp"

namespace tribench::testing {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Words = std::vector<std::string>;

Words with(Words words, const std::string& more) {
  words.push_back(more);
  return words;
}

// As the program would, without starting it: a thousand lines take a tenth of the time.
ProgramRun run_in_this_process(Words words) {
  words.insert(words.begin(), "tribench");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  static const Registry kRegistry;
  ::testing::internal::CaptureStderr();
  ProgramRun run;
  run.status = run_program(static_cast<int>(words.size()), pointers.data(), kRegistry);
  run.errors = ::testing::internal::GetCapturedStderr();
  return run;
}

// Subcommands below `command`, and theirs.
std::vector<Words> commands_below(const Words& command) {
  std::vector<Words> all;
  std::istringstream help(run_tribench(with(command, "--help")).output);
  const std::regex line_of_command("^  ([a-z][a-z-]*) .*");
  bool below = false;
  for (std::string line; std::getline(help, line);) {
    std::smatch match;
    if (line == "Subcommands:") below = true;
    if (!below || !std::regex_match(line, match, line_of_command)) continue;
    all.push_back(with(command, match[1]));
    const std::vector<Words> deeper = commands_below(all.back());
    all.insert(all.end(), deeper.begin(), deeper.end());
  }
  return all;
}

// A figure in seconds differs from one run to the next.
std::string without_times(const std::string& text) {
  return std::regex_replace(
      text, std::regex("[-0-9.e]+ (CPU seconds|s\\b)|\"[a-z_]*(seconds|_s)\": [-0-9.e]+"), "?");
}

Words numeric_options(const Words& command) {
  Words options;
  std::istringstream help(run_tribench(with(command, "--help")).output);
  const std::regex line_of_option("^  (?:-., *)?(--[a-z-]+) (?:INT|UINT|FLOAT).*");
  for (std::string line; std::getline(help, line);) {
    std::smatch match;
    if (std::regex_match(line, match, line_of_option)) options.push_back(match[1]);
  }
  return options;
}

// Languages with a comma in numbers, and one in which "I" is no capital "i".
TEST(CommandLine, ALocaleChangesNoNumber) {
  const TemporaryFolder folder;
  const std::string csv = (folder / "lines.csv").string();
  std::string rows = "x,y,I_A\n";
  for (int i = 0; i < 40; ++i) {
    const double x = 0.1 * i;
    rows += std::to_string(x) + "," + std::to_string(1.5 * x + 0.25) + ",0.5\n";
  }
  write_text(csv, rows);
  const std::vector<Words> asked = {{"export", "1.5*v + exp(v)", "--as", "c"},
                                    {"check", "1/(v - 0.5)", "--box", "v=-2.5:2.5", "--json"},
                                    {"fit", csv, "--target", "y", "--inputs", "x,I_A", "--method",
                                     "linear", "--save", (folder / "model.json").string()},
                                    {"predict", (folder / "model.json").string(), csv}};
  for (const std::string locale : {"de_DE", "tr_TR"}) {
    const std::string made = (folder / (locale + ".UTF-8")).string();
    const ProgramRun making = run_to_end({"localedef", "-i", locale, "-f", "UTF-8", made});
    if (!std::filesystem::exists(made)) GTEST_SKIP() << "no localedef: " << making.errors;
    for (const Words& words : asked) {
      Words there = {"env", "LOCPATH=" + (folder / ".").string(), "LC_ALL=" + locale + ".UTF-8",
                     program().string()};
      there.insert(there.end(), words.begin(), words.end());
      const ProgramRun here = run_tribench(words);
      const ProgramRun abroad = run_to_end(there);
      EXPECT_EQ(abroad.status, here.status) << locale << " " << words.front();
      EXPECT_EQ(without_times(abroad.output), without_times(here.output)) << locale;
    }
  }
}

TEST(CommandLine, EveryNumberIsReadStrictly) {
  std::size_t asked = 0;
  for (const Words& command : commands_below({})) {
    for (const std::string& option : numeric_options(command)) {
      for (const char* text : {"nan", "inf", "1xyz", "0x10", "1'000", "1e999", "-1", "text"}) {
        const ProgramRun run = run_in_this_process(with(with(command, option), text));
        EXPECT_EQ(run.status, 2) << command.back() << " " << option << " " << text;
        EXPECT_THAT(run.errors, HasSubstr("cannot be used; use a"))
            << command.back() << " " << option << " " << text;
        ++asked;
      }
    }
  }
  EXPECT_GT(asked, 200U);
}

TEST(CommandLine, ANumberBeyondAllIsAnsweredWithTheLargest) {
  for (const char* number : {"1e30", "99999999999999999999", "0"}) {
    EXPECT_THAT(run_tribench({"fit", "log.csv", "--evaluations", number}).errors,
                HasSubstr("use a whole number from 1 to 18446744073709551615"));
  }
}

TEST(CommandLine, BudgetsMayBeWrittenWithAnExponent) {
  const ProgramRun run = run_tribench({"fit", "no-such-file.csv", "--target", "t", "--inputs", "v",
                                       "--method", "linear", "--evaluations", "1e11"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("no-such-file.csv"));
}

TEST(CommandLine, UnknownWordsAreAnsweredWithTheNearest) {
  const auto expect = [](const Words& words, const char* said) {
    const ProgramRun run = run_tribench(words);
    EXPECT_EQ(run.status, 2) << words.back();
    EXPECT_THAT(run.errors, HasSubstr(said));
  };
  expect({"frobnicate"}, "there is no subcommand 'frobnicate'; known: run, fit");
  expect({"lisst"}, "did you mean list?");
  expect({"list", "problms"}, "did you mean problems?");
  expect({"fit", "--metod", "x"}, "there is no option '--metod'; did you mean --method?");
  expect({"run", "--jbos=3"}, "there is no option '--jbos'; did you mean --jobs?");
  expect({"run", "quick", "more"}, "there is no further argument 'more'");
  expect({"run", "qiuck"}, "there is no grid 'qiuck'; did you mean quick?");
  expect({"run", "--vers"}, "there is no option '--vers'; see: tribench run --help");
  expect({"--vers"}, "did you mean --version?");
  // A formula may begin with a minus.
  expect({"export", "-x^2", "--as", "c"},
         "there is no option '-x^2'; a formula that begins with a minus stands behind '--'");
  expect({"export", "--", "-x^2"}, "--as is required");
  expect({"check", "--", "-x^2", "--box", "x=1:2"},
         "'--box' stands behind '--', where nothing is an option; put options in front of it");
  expect({"describ"}, "there is no subcommand 'describ'; known: run, fit");  // not for users
  expect({}, "A subcommand is required");
}

// The grid's own file is held to the same bound.
TEST(CommandLine, MoreCellsThanARunCanHoldAreRefusedBeforeTheyAreMade) {
  const ProgramRun run = run_tribench({"run", "paper", "--seeds", "1000000", "--dry-run"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("--seeds: the grid has "));
  EXPECT_THAT(run.errors, HasSubstr("use at most 1000000"));
}

// Each as a list of words took 0.7 kB.
TEST(CommandLine, ADryRunOfAMillionCellsTakesLittleMemory) {
  if (kIsSanitized) GTEST_SKIP() << kNothingToMeasure;
  const TemporaryFolder folder;
  write_text(folder / "grid.toml",
             "[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"linear\"]\n"
             "operators = [\"paper\"]\nseeds = { first = 1, count = 1_000_000 }\n");
  reset_peak_memory_of_children();
  const ProgramRun run = run_tribench({"run", (folder / "grid.toml").string(), "--dry-run"});
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("\n1000000 cells, at most "));
  EXPECT_LT(peak_memory_of_children_mib(), 200);
}

// What budgets allow at most is no prediction.
TEST(CommandLine, ADryRunPredictsNothingWithoutARunToGoBy) {
  const ProgramRun run = run_tribench({"run", "quick", "--dry-run", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("\"predicted_wall_s\": null"));
  EXPECT_THAT(run.output, HasSubstr("\"basis\": \"budgets\""));
}

// A name may hold what a terminal obeys.
TEST(CommandLine, AnErrorSendsNoCommandToTheTerminal) {
  const ProgramRun run = run_tribench(
      {"fit", "no\x1b[2Jsuch.csv", "--target", "y", "--inputs", "x", "--method", "linear"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("no?[2Jsuch.csv"));
}

TEST(CommandLine, AllThatIsMissingIsSaidAtOnceWithAnExample) {
  const ProgramRun run = run_tribench({"fit"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("tribench: DATA is required: the data file (CSV)\n"));
  EXPECT_THAT(run.errors, HasSubstr("tribench: --target is required: the column to explain\n"));
  EXPECT_THAT(run.errors, HasSubstr("Example: tribench fit "));
  EXPECT_THAT(run.errors, HasSubstr("see: tribench fit --help\n"));
}

TEST(CommandLine, NothingIsWrittenToAPlaceWithoutAName) {
  for (const Words& words :
       {Words{"run", "quick", "--out", ""}, Words{"loop", "log.csv", "--out", ""},
        Words{"generate", "A/j2/load", "--out", ""},
        Words{"submit", "quick", "--slurm", "--dry-run", "--out", ""},
        Words{"nightly", "--store", ""},
        Words{"check", "v", "--box", "v=0:1", "--certificate", ""}}) {
    const ProgramRun run = run_tribench(words);
    EXPECT_EQ(run.status, 2) << words.front();
    EXPECT_THAT(run.errors, HasSubstr("use the name of a file or folder")) << words.front();
  }
}

// Readers skip a blank line, and every row below it would get another row's prediction.
TEST(CommandLine, APredictionWithoutAValueKeepsItsRow) {
  const TemporaryFolder folder;
  const std::string data = (folder / "rows.csv").string();
  write_text(data, "v\n-1\n4\n-2\n9\n");
  EXPECT_EQ(run_tribench({"predict", "sqrt(v)", data}).output, "prediction\nnan\n2\nnan\n3\n");
}

// 3*sgn_v is proved and exported with the sign of v, whatever the file holds.
TEST(CommandLine, APredictionTakesNoOtherColumnForASign) {
  const TemporaryFolder folder;
  const std::string data = (folder / "rows.csv").string();
  const auto predicted = [&](const std::string& rows, const std::string& model = "3*sgn_v") {
    write_text(data, rows);
    return run_tribench({"predict", model, data});
  };
  EXPECT_EQ(predicted("sgn_v\n-1\n0\n1\n").output, "prediction\n-3\n0\n3\n");
  EXPECT_EQ(predicted("v\n-0.5\n2\n").output, "prediction\n-3\n3\n");
  const ProgramRun half = predicted("sgn_v\n-1\n0.5\n1\n");
  EXPECT_EQ(half.status, 2);
  EXPECT_THAT(half.errors, HasSubstr(data + ":3:sgn_v: '0.5' cannot be used; sgn_v stands for the "
                                            "sign of v: -1, 0 or 1"));
  const ProgramRun other = predicted("v,sgn_v\n-0.5,-1\n2,-1\n");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr(data + ": 'sgn_v' is -1 where 'v' is 2"));
  // A model of its own knows what it was fitted to.
  const std::string model = (folder / "m.json").string();
  write_text(model, R"({"formula": "3*sgn_v", "inputs": ["sgn_v"]})");
  EXPECT_EQ(predicted("sgn_v\n0.5\n", model).output, "prediction\n1.5\n");
  write_text(model, R"({"formula": "3*sgn_v", "inputs": ["v", "sgn_v"]})");
  EXPECT_EQ(predicted("sgn_v\n0.5\n", model).status, 2);
}

TEST(CommandLine, WhatIsReadIsNotWrittenOver) {
  const TemporaryFolder folder;
  const std::string data = (folder / "joint.csv").string();
  const std::string rows = "x,y\n1,2\n2,4.5\n3,5.5\n4,8\n";
  write_text(data, rows);
  std::filesystem::create_symlink("joint.csv", folder / "link");
  const std::string link = (folder / "link").string();
  const Words fit = {"fit", data, "--target", "y", "--inputs", "x", "--method", "linear"};
  for (const Words& words :
       {with(with(fit, "--save"), data), with(with(fit, "--save"), link),
        Words{"predict", "2*x", data, "--out", data}, Words{"predict", "2*x", link, "--out", data},
        Words{"world", "w", "execute", data, "--out", link}}) {
    const ProgramRun run = run_tribench(words);
    EXPECT_EQ(run.status, 2) << words.front();
    EXPECT_THAT(run.errors, HasSubstr("is read by this command")) << words.front();
  }
  EXPECT_EQ(read_text(data), rows);
  EXPECT_EQ(run_tribench({"predict", "2*x", data, "--out", (folder / "new").string()}).status, 0);
  EXPECT_EQ(run_tribench({"predict", "2*x", data, "--out", (folder / "new").string()}).status, 0);
}

// A shell's variable that was not set: nothing would be held out, verified or compared.
TEST(CommandLine, AnEmptyWordIsNotTakenForAnOptionThatWasNotGiven) {
  for (const Words& words :
       {Words{"fit", "log.csv", "--target", "y", "--inputs", "x", "--test", ""},
        Words{"run", "quick", "--verify", ""}, Words{"run", "quick", "--quarantine", ""},
        Words{"report", "run", "--base", ""}, Words{"report", ""},
        Words{"compare", "run", "run", "--history", ""}, Words{"challenge", "--secret-file", ""}}) {
    const ProgramRun run = run_tribench(words);
    EXPECT_EQ(run.status, 2) << words.front();
    EXPECT_THAT(run.errors, HasSubstr("'' cannot be used")) << words.front();
  }
}

TEST(CommandLine, ANameThatNoFileCanHaveIsBadInput) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("ring", folder / "ring");
  for (const std::string& name : {(folder / "ring").string(), std::string(300, 'x')}) {
    for (const Words& words : {Words{"report", name}, Words{"compare", name, name},
                               Words{"world", name, "reveal"}, Words{"explore", name}}) {
      const ProgramRun run = run_tribench(words);
      EXPECT_EQ(run.status, 2) << words.front();
      EXPECT_THAT(run.errors, StartsWith("tribench: " + name)) << words.front();
      EXPECT_THAT(run.errors, AnyOf(HasSubstr("symbolic links"), HasSubstr("too long")));
    }
  }
}

TEST(CommandLine, WhereOneOfAFewWordsIsWantedTheyAreSaid) {
  const auto expect = [](const Words& words, const char* said) {
    const ProgramRun run = run_tribench(words);
    EXPECT_EQ(run.status, 2) << words.back();
    EXPECT_THAT(run.errors, HasSubstr(std::string("cannot be used; use ") + said));
  };
  expect({"world", "3", "--level", "hrad"}, "easy, medium, hard");
  expect({"world", "3", "--level", "2"}, "easy, medium, hard");  // not an enumerator's number
  expect({"world", "3", "--kind", ""}, "none, single, pair, unknown");
  expect({"loop", "log.csv", "--gravity", "on"}, "auto, fit, none");
  expect({"study", "loop", "--generator", "real"}, "planted, simulated");
}

// The program with these words and redirections, below what bash does first.
ProgramRun run_redirected(const std::string& words, const std::string& first = "true") {
  return run_to_end({"bash", "-c", first + "; exec \"$0\" " + words, program().string()});
}

// Closed, or on a disk that is full.
TEST(CommandLine, OutputThatDoesNotArriveIsAFailure) {
  for (const char* words : {"list methods > /dev/full", "list methods >&-",
                            "list methods --json > /dev/full", "--version > /dev/full"}) {
    EXPECT_EQ(run_redirected(words).status, 3) << words;
  }
  EXPECT_EQ(run_redirected("list methods > /dev/null").status, 0);
}

TEST(CommandLine, MessagesThatNobodyHearsChangeNothing) {
  for (const char* words : {"fit missing.csv --target y --inputs x --method linear 2>&-",
                            "fit missing.csv --target y --inputs x --method linear 2> /dev/full",
                            "fit missing.csv --target y --inputs x --method linear <&- >&- 2>&-"}) {
    const ProgramRun run = run_redirected(words);
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_EQ(run.signal, 0) << words;
  }
}

// Read to its end, /dev/zero would take all memory and never come to an answer.
TEST(CommandLine, ADeviceWithoutAnEndIsRefusedByEveryReader) {
  const TemporaryFolder folder;
  const std::string data = "'" + (folder / "joint.csv").string() + "'";
  const std::string out = " --out '" + (folder / "out").string() + "'";
  ASSERT_EQ(run_redirected("generate A/j2/load --out " + data).status, 0);
  std::filesystem::create_directory(folder / "run");
  std::filesystem::create_symlink("/dev/zero", folder / "run/cells.jsonl");
  const std::string run_folder = "'" + (folder / "run").string() + "'";
  for (const std::string& words :
       {"run /dev/zero" + out, "run /dev/stdin" + out, "run --quarantine /dev/zero" + out,
        "run --data-file /dev/zero --target y --methods linear" + out,
        std::string("fit /dev/zero --target y --inputs x --method linear"), "loop /dev/zero" + out,
        "loop " + data + " --learned /dev/zero" + out, std::string("check --verify /dev/zero"),
        "report " + run_folder, "merge " + run_folder + out}) {
    const ProgramRun run = run_redirected(words + " </dev/zero", "ulimit -t 20");
    EXPECT_EQ(run.status, 2) << words << run.errors;
    EXPECT_EQ(run.signal, 0) << words;
    EXPECT_THAT(run.errors,
                AnyOf(HasSubstr("/dev/zero"), HasSubstr("/dev/stdin"), HasSubstr("cells.jsonl")))
        << words;
  }
}

// A folder or file that cannot be written is found before the work and not after it.
TEST(CommandLine, AnOutputThatCannotBeWrittenIsFoundFirst) {
  const TemporaryFolder folder;
  const std::string made = (folder / "run").string();
  const ProgramRun run = run_tribench({"run", "quick", "--seeds", "1", "--evaluations", "1",
                                       "--out", made, "--pictures", "/proc/no/such"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.errors, HasSubstr("/proc/no/such: cannot make the folder"));
  EXPECT_FALSE(std::filesystem::exists(made));
  for (const Words& words :
       {Words{"--page", "/proc/no/such.md"}, Words{"--pictures", "/proc/no/such"},
        Words{"--as", "latex", "--out", "/proc/no/such.tex"}}) {
    Words all = {"report", folder.path().string()};  // which is no run: that is found later
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_THAT(run_tribench(all).errors, HasSubstr("/proc/no/such")) << words.front();
  }
}

TEST(CommandLine, AProgramThatDrawsIsMissedBeforeTheWork) {
  const TemporaryFolder folder;
  const std::string made = (folder / "run").string();
  const std::string pictures = (folder / "pictures").string();
  const Words run = {"run", "quick", "--seeds", "1", "--evaluations", "1", "--out", made};
  // A folder that is no run, a recording that is none: these are found later.
  for (Words words : {run, Words{"report", folder.path().string()}, Words{"loop", "/dev/null"}}) {
    words.insert(words.end(), {"--pictures", pictures});
    words.insert(words.begin(), program().string());
    const ProgramRun done = run_to_end(words, {"PATH=" + folder.path().string()});
    EXPECT_EQ(done.status, 3);
    EXPECT_THAT(done.errors, HasSubstr("apt-get install nodejs")) << words[1];
  }
  EXPECT_FALSE(std::filesystem::exists(made));
}

// `ulimit -f` counts in kilobytes, and the problem has 100 of them.
TEST(CommandLine, ALimitOnFileSizesIsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  const ProgramRun run = run_redirected(
      "generate A/j2/load --out '" + (folder / "data.csv").string() + "'", "ulimit -f 8");
  EXPECT_EQ(run.status, 3) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("data.csv: cannot be written: File too large"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace tribench::testing
