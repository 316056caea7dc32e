// SPDX-License-Identifier: MIT
//
// What the tests of `tribench loop` share: data to run it on, and what it names.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_program.hpp"

namespace tribench::testing {

inline std::string generated(const TemporaryFolder& folder, const std::string& problem,
                             const std::string& seed) {
  const std::string file = (folder / ("data" + seed + ".csv")).string();
  EXPECT_EQ(run_tribench({"generate", problem, "--seed", seed, "--out", file}).status, 0);
  return file;
}

inline std::vector<std::string> families(const nlohmann::json& loop) {
  std::vector<std::string> names;
  for (const nlohmann::json& effect : loop["effects"]) names.push_back(effect["family"]);
  return names;
}

}  // namespace tribench::testing
