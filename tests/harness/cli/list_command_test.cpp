// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;

ProgramRun list(std::vector<std::string> words) {
  words.insert(words.begin(), {program().string(), "list"});
  return run_to_end(words);
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

}  // namespace
}  // namespace tribench::testing
