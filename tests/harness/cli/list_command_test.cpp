// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;

ProgramRun list(std::vector<std::string> words) {
  words.insert(words.begin(), "list");
  return run_tribench(words);
}

TEST(ListCommand, GivesTheMethodsWithTheirParameters) {
  const ProgramRun run = list({"methods", "--json"});
  ASSERT_EQ(run.status, 0);
  bool found = false;
  for (const auto& method : nlohmann::json::parse(run.output)) {
    if (method.at("name") != "pysr") continue;
    for (const auto& parameter : method.at("parameters")) {
      if (parameter.at("name") != "max_size") continue;
      found = true;
      EXPECT_EQ(parameter.at("default"), -1);
      EXPECT_EQ(parameter.at("high"), 500);
      EXPECT_THAT(parameter.at("summary").get<std::string>(), HasSubstr("number of nodes"));
    }
  }
  EXPECT_TRUE(found);
}

TEST(ListCommand, GivesTheParametersOfOneMethodAsText) {
  const ProgramRun run = list({"methods", "pysr"});
  ASSERT_EQ(run.status, 0);
  EXPECT_THAT(run.output, HasSubstr("template "));
  EXPECT_THAT(run.output, HasSubstr("one of [\"native\",\"v1\",\"v2\"] [\"native\"]"));
  const ProgramRun unknown = list({"methods", "pyrs"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("did you mean pysr?"));
}

TEST(ListCommand, NamesEveryGridThatIsShipped) {
  const ProgramRun run = list({"grids", "--json"});
  std::vector<std::string> names;
  for (const auto& grid : nlohmann::json::parse(run.output)) names.push_back(grid.at("name"));
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "grids")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().stem());
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAreArray(files));
}

TEST(ListCommand, SaysOfOneProblemWhatItIsMadeOf) {
  const ProgramRun run = list({"problems", "B/j2/load", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto problem = nlohmann::json::parse(run.output).at(0);
  EXPECT_EQ(problem.at("name"), "B/j2/load");
  EXPECT_EQ(problem.at("target").at("unit"), "N m");
  EXPECT_EQ(problem.at("stages").size(), 2U);
  EXPECT_GT(problem.at("test").at("movements"), 1);
  for (const auto& input : problem.at("inputs")) EXPECT_LT(input.at("low"), input.at("high"));
  const ProgramRun text = list({"problems", "nguyen/1"});
  EXPECT_THAT(text.output, HasSubstr("x^3"));
  EXPECT_THAT(text.output, HasSubstr("-1 to 1"));
  const ProgramRun some = list({"problems", "nguyen/*"});
  EXPECT_EQ(std::ranges::count(some.output, '\n'), 12);
  const ProgramRun unknown = list({"problems", "nguyen/99"});
  EXPECT_EQ(unknown.status, 2);
  const ProgramRun absent = list({"problems", "emps/estimation", "--data", "/nowhere"});
  EXPECT_EQ(absent.status, 2);
  EXPECT_THAT(absent.errors, HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace tribench::testing
