// SPDX-License-Identifier: MIT
#include "reports/proofs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "foundation/output_file.hpp"
#include "foundation/random.hpp"
#include "reports/record/record_csv.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Record record_of(const std::string& operators, std::uint64_t seed, double error) {
  Record r;
  r.method = "pysr";
  r.problem = "A/j2/load";
  r.operators = operators;
  r.seed = seed;
  r.cell = "A/j2/load|pysr|" + operators + "|" + std::to_string(seed);
  r.status = CellStatus::ok;
  r.mae_test = error;
  r.singularity = Singularity::proved_free;
  r.formula = operators == "paper" ? "2*qd" : "2/(qd + 1)";
  return r;
}

TEST(Divides, CountsDivisorsThatAreNoPlainNumber) {
  for (const char* formula : {"1/qd", "a / (b + 1)", "a/exp(b)", "qd^-2", "qd^(-1)", "a/2^b",
                              "a/2 + b/c", "1/-qd", "a/.5^x"}) {
    EXPECT_TRUE(divides(formula)) << formula;
  }
  for (const char* formula :
       {"qd", "qd/0.65", "a/ -2", "a/1.5e-3*b", "a/.5 + b^2", "exp(-qd)", ""}) {
    EXPECT_FALSE(divides(formula)) << formula;
  }
}

TEST(Proofs, CountVerdictsOfCellsAndFronts) {
  RunFolder run;
  run.path = fresh_folder("proofs");
  run.records = {record_of("paper", 1, 1), record_of("paper+div", 1, 1),
                 record_of("paper+div", 2, 4), record_of("paper+safe_div", 1, 2)};
  run.records[1].singularity = Singularity::refuted;
  run.records[1].grid_check = GridCheck::missed;
  run.records[2].dissipative = PhysicsProof::proved;
  run.records.push_back(record_of("paper", 2, 1));
  run.records.back().status = CellStatus::failed;
  const std::string cell = run.records[1].cell;
  write_file(run.path / "front.csv",
             front_csv({{cell, 3, 3, 1, 1, Singularity::refuted, true, "1/qd"},
                        {cell, 1, 1, 2, 2, Singularity::proved_free, false, "qd"},
                        {"nobody's", 1, 1, 2, 2, Singularity::refuted, false, "1/qd"}}));
  const std::string text = proofs_section(run);
  EXPECT_THAT(text,
              HasSubstr("| paper+div      | pysr   |        2 |        2 |           1 |         0 "
                        "|       1 |           1/1 |                 1/2 |     1/2 |"));
  EXPECT_THAT(text, HasSubstr("| paper          | pysr   |        1 |        0 |"));
  EXPECT_THAT(text,
              HasSubstr("| paper+div      | pysr   |        2 |           1 |"));  // dissipative
  EXPECT_EQ(proofs_section({}), "");
}

TEST(OperatorPrice, FindsAPlantedCostAndSaysWhenThereIsNone) {
  std::vector<Record> records;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed);
    const double error = 1 + random.uniform();
    records.push_back(record_of("paper", seed, error));
    records.push_back(record_of("paper+div", seed, error * (1 + 0.001 * random.uniform(-1, 1))));
    records.push_back(
        record_of("paper+safe_div", seed, 1.1 * error * (1 + 0.01 * random.uniform())));
  }
  const std::vector<OperatorPrice> prices = operator_prices(records);
  ASSERT_EQ(prices.size(), 3U);
  EXPECT_EQ(prices[0].operators, "paper+safe_div");
  EXPECT_EQ(prices[0].against, "paper");
  EXPECT_EQ(prices[0].pairs, 20U);
  EXPECT_NEAR(prices[0].ratio, 1.105, 0.006);
  EXPECT_GT(prices[0].interval.low, 1.09);
  EXPECT_LT(prices[0].p, 0.001);
  EXPECT_TRUE(prices[2].interval.contains(1));
  RunFolder run;
  run.records = records;
  const std::string text = proofs_section(run);
  EXPECT_THAT(text, HasSubstr("| costs "));
  EXPECT_THAT(text, HasSubstr("| no practical difference |"));
}

TEST(OperatorPrice, CountsAFailedCellAsInfinite) {
  std::vector<Record> records = {record_of("paper", 1, 1), record_of("paper+safe_div", 1, 1)};
  records[1].status = CellStatus::failed;
  const std::vector<OperatorPrice> prices = operator_prices(records);
  ASSERT_EQ(prices.size(), 1U);
  EXPECT_TRUE(std::isinf(prices[0].ratio));
  RunFolder run;
  run.records = {records[0]};
  EXPECT_THAT(proofs_section(run), Not(HasSubstr("error ratio")));
}

}  // namespace
}  // namespace tribench
