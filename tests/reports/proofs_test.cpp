// SPDX-License-Identifier: MIT
#include "reports/proofs.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tribench {
namespace {

Record record_of(const std::string& operators, std::uint64_t seed, double error) {
  Record r;
  r.method = "pysr";
  r.problem = "A/j2/load";
  r.operators = operators;
  r.seed = seed;
  r.status = "ok";
  r.mae_test = error;
  r.singularity = "proved_free";
  return r;
}

TEST(Proofs, count_verdicts_and_price_safety) {
  std::vector<Record> records = {record_of("paper+div", 1, 1), record_of("paper+div", 2, 4),
                                 record_of("paper+safe_div", 1, 2),
                                 record_of("paper+safe_div", 2, 2)};
  records[0].singularity = "refuted";
  records[0].grid_check = "missed";
  records[1].dissipative = "proved";
  records.push_back(record_of("paper", 1, 1));
  records.back().status = "failed";
  const std::string text = proofs_section(records);
  EXPECT_NE(text.find("paper+div"), std::string::npos);
  // 2/1 and 2/4: a geometric mean of 1.
  EXPECT_NE(text.find("`paper+safe_div` is 1 times that with `paper+div` (2 pairs)"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("`paper` ("), std::string::npos);
  EXPECT_EQ(proofs_section({}), "");
}

}  // namespace
}  // namespace tribench
