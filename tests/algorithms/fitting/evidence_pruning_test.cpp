// SPDX-License-Identifier: MIT
#include "algorithms/fitting/evidence_pruning.hpp"
#include "algorithms/fitting/free_constants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench::evidence_pruning_test {
namespace {

const std::vector<std::string> kNames = {"x", "z"};
const InputBox kBox = {{1, 4}, {1, 4}};

struct Rows {
  Rows(const std::string& law, double noise) {
    RandomStream random(61);
    for (int r = 0; r < 300; ++r) {
      x.push_back(random.uniform(1, 4));
      z.push_back(random.uniform(1, 4));
    }
    y.resize(x.size());
    Evaluator().evaluate(parse(law, kNames), table(), y);
    for (double& value : y) value += noise * random.normal();
  }
  Inputs table() const {
    pointers = {x.data(), z.data()};
    return {pointers, x.size()};
  }
  // most: fits that are paid for.
  std::string pruned(const std::string& formula, int most = 1'000'000) const {
    const auto spend = [&most](std::uint64_t) { return --most > 0; };
    return print(pruned_by_evidence(parse(formula, kNames), table(), y, kBox, spend), kNames);
  }
  std::vector<double> x, z, y;
  mutable std::vector<const double*> pointers;
};

TEST(EvidencePruning, MakesExponentsWholeAndLeavesOutWhatIsNone) {
  const Rows rows("3*x^2/z", 0.1);
  const std::string text = rows.pruned("2.9*x^2.02*z^-0.97 + 0.003*z^1.1");
  const Expression pruned = parse(text, kNames);
  EXPECT_EQ(free_exponents(pruned), 0U) << text;
  EXPECT_EQ(paper_complexity(pruned), paper_complexity(parse("3*x^2/z", kNames))) << text;
}

TEST(EvidencePruning, LeavesWhatTheRowsSay) {
  const Rows rows("3*x^1.8 + 0.5*z", 0.01);
  const std::string text = rows.pruned("3*x^1.8 + 0.5*z");
  EXPECT_EQ(free_exponents(parse(text, kNames)), 1U) << text;
  EXPECT_NE(text.find('z'), std::string::npos) << text;
}

TEST(EvidencePruning, DoesNothingWithoutABudget) {
  const Rows rows("3*x^2/z", 0.1);
  EXPECT_EQ(rows.pruned("2.9*x^2.02*z", 1), "2.9*x^2.02*z");
}

TEST(EvidencePruning, EndsWhereNoNumberIsLeft) {
  EXPECT_EQ(Rows("x^2/z", 0.1).pruned("1.01*x^2/z"), "x^2/z");
}

// On many rows there is time for few fits: what goes most likely is tried first, and kept.
TEST(EvidencePruning, LeavesOutWhatItCanWhereTheBudgetIsShort) {
  const Rows rows("3*x^2/z", 0.1);
  const std::string formula = "2.9*x^2*z^-1 + 0.3 - 0.1*x - 0.03*z";
  EXPECT_EQ(rows.pruned(formula, 5), rows.pruned(formula));
  EXPECT_EQ(paper_complexity(parse(rows.pruned(formula, 5), kNames)),
            paper_complexity(parse("3*x^2/z", kNames)));
}

TEST(EvidencePruning, CountsExponentsThatWereFitted) {
  EXPECT_EQ(free_exponents(parse("x^2 + z^-0.5 + x^0.3333333333333333 + z^1.23 + 2.5*x", kNames)),
            1U);
}

}  // namespace
}  // namespace tribench::evidence_pruning_test
