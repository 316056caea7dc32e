// SPDX-License-Identifier: MIT
#include "algorithms/relay/answer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/relay/drawn_law.hpp"

namespace tribench::answer_test {
namespace {

using testing::DrawnLaw;

constexpr std::size_t kRows = 600;
const std::string kSum = "2*x*z + 3 + 0.001*abs(x - 0.5) - 0.001*abs(z - 0.2)*x";

// What stands where `law` is offered and a long sum whose held-out errors, fold by fold, are the
// law's times `part`.
std::string stands_beside_sum(const std::string& law, const std::vector<double>& part) {
  const DrawnLaw rows("2*x*z + 3", {{"x", -2, 2}, {"z", -1, 3}}, kRows, 0.05);
  const TrainingData data = rows.data();
  Budget budget({});
  FitContext context{data, find_operator_set("full"), budget, RandomStream(1)};
  relay::Answer answer(context);
  answer.offer(parse(law, rows.names), "the test");
  const Expression formula = answer.likeliest();
  std::vector<double> errors = relay::held_out_errors(formula, answer.rows(), kRows);
  for (std::size_t f = 0; f < errors.size(); ++f) errors[f] *= part[f % part.size()];
  answer.set_rival({parse(kSum, rows.names), errors}, kRows);
  const FitResult result = std::move(answer).result();
  return print(result.front[result.chosen], rows.names);
}

TEST(Answer, YieldsToALongSumThatIsNearerToUnseenRowsByMoreThanChance) {
  EXPECT_EQ(stands_beside_sum("2*x*z + 3", {0.6, 0.7}), kSum);
}

TEST(Answer, StandsWhereALongerSumIsNearerByChance) {
  EXPECT_NE(stands_beside_sum("2*x*z + 3", {0.95, 1.04}), kSum);
}

}  // namespace
}  // namespace tribench::answer_test
