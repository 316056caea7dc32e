// SPDX-License-Identifier: MIT
#include "algorithms/fitting/held_out_choice.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"v"};

// Rows of 2 v with noise, and formulas over them.
struct Rows {
  std::vector<double> v;
  std::vector<double> target;
  const double* column = nullptr;

  explicit Rows(int count, double noise = 0.3) {
    RandomStream random(7);
    for (int r = 0; r < count; ++r) {
      v.push_back(random.uniform(-1, 1));
      target.push_back(2 * v.back() + noise * random.normal());
    }
    column = v.data();
  }
  std::size_t choice_of(const std::vector<std::string>& texts, std::size_t chosen) const {
    std::vector<Expression> front;
    for (const std::string& text : texts) front.push_back(parse(text, kNames));
    return held_out_choice(front, chosen, {{&column, 1}, v.size()}, target, {});
  }
};

// Through nearly every one of few rows, and far off between them.
const std::string kWild =
    "0.1 + 2*v + 3*v^2 + 4*v^3 + 5*v^4 + 6*v^5 + 7*v^6 + 8*v^7 + 9*v^8 + 10*v^9 + 11*v^10 + "
    "12*v^11 + 13*v^12 + 14*v^13 + 15*v^14";

TEST(HeldOutChoice, TakesThePlaceOfAFormulaThatFoldsSpeakPlainlyAgainst) {
  EXPECT_EQ(Rows(22).choice_of({"0.5", "2*v", kWild}, 2), 1U);
}

TEST(HeldOutChoice, LeavesAChoiceThatIsHardlyWorse) {
  EXPECT_EQ(Rows(60).choice_of({"0.5", "2*v", "2*v + 0.1*v^2"}, 2), 2U);
  EXPECT_EQ(Rows(60).choice_of({"2*v"}, 0), 0U);
}

TEST(HeldOutChoice, LeavesManyRowsToTheMethods) {
  EXPECT_EQ(Rows(401).choice_of({"0.5", "2*v"}, 0), 0U);
  EXPECT_EQ(Rows(400).choice_of({"0.5", "2*v"}, 0), 1U);
}

}  // namespace
}  // namespace tribench
