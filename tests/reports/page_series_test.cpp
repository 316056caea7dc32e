// SPDX-License-Identifier: MIT
#include "reports/html/page_series.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "reports/record/record_csv.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

// A front of 500 formulas is cut for the page. What people came for is not among what goes.
TEST(Fronts, KeepTheChosenTheSimplestAndTheMostAccurateHoweverLongTheyAre) {
  const std::filesystem::path folder = fresh_folder("long_front");
  write_sample_run(folder, 4);
  const std::string cell = sample_records(4).front().cell;
  std::vector<FrontRecord> front;
  for (int k = 1; k <= 500; ++k) {
    // The 498th is the most accurate; the one chosen lies where an even choice would skip it.
    front.push_back({.cell = cell,
                     .complexity = k,
                     .nodes = k,
                     .mae_train = 1.0 / k,
                     .mae_test = k == 498 ? 1e-3 : 1.0 / k,
                     .singularity = Singularity::proved_free,
                     .chosen = k == 341,
                     .formula = "formula_" + std::to_string(k)});
  }
  std::ofstream(folder / "front.csv") << front_csv(front);
  const nlohmann::ordered_json kept = fronts_json(read_run_folder(folder));
  std::vector<std::string> formulas;
  for (const auto& one : kept) formulas.push_back(one.at("formula"));
  EXPECT_LT(formulas.size(), 100U);
  for (const char* must : {"formula_1", "formula_341", "formula_498"}) {
    EXPECT_TRUE(std::ranges::find(formulas, must) != formulas.end()) << must;
  }
  EXPECT_EQ(std::ranges::count_if(kept, [](const auto& one) { return one.at("chosen"); }), 1);
}

}  // namespace
}  // namespace tribench
