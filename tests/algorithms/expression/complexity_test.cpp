// SPDX-License-Identifier: MIT
#include "algorithms/expression/complexity.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

struct PublishedFormula {
  const char* id;
  const char* text;
  int complexity;  // by the rule
};

// Scholl et al. 2025, tables 1 and 3 and the load-dependent equation.
constexpr PublishedFormula kPublished[] = {
    {"A2-parfam",
     "(3.66*qd + 8.52*sgn_qd - 0.44)*exp(-0.78*qd^2 + 1.26*qd*sgn_qd + 0.02*qd - 0.02*sgn_qd)", 22},
    {"A2-pysr", "-4.283*qd^4*sgn_qd + (8.452 - 0.215*sgn_qd)*(1.842*qd + sgn_qd - 0.049)", 15},
    {"A2-udsr",
     "-8.083*qd^3 + 4.643*qd^2*sgn_qd - 0.068*qd^2 - 0.639*qd*sgn_qd + 13.609*qd + 0.827*sgn_qd + "
     "0.827*sgn_qd + exp(qd) + exp(exp(sgn_qd)) - 9.899",
     35},
    {"A2-symmetric", "sgn_qd*(1193 + (8.629 - 1193)*exp(-abs(qd/47.65)^8.827)) + 14.44*qd", 13},
    {"B2-parfam", "-0.012*g^2 + 0.016*g*sgn_qd + 0.176*g*sgn_g - 0.169*g + 0.712*sgn_qd + 1.036",
     20},
    {"B2-pysr", "(sgn_g - 0.9893261)^2", 3},
    {"B2-udsr", "0.330*sgn_qd*(g - 1)", 5},
    {"AL2-parfam",
     "-1.12*qd^2 + 0.01*qd*g + 1.095*qd*sgn_qd - 0.01*qd*sgn_g - 14.87*qd + 0.026*g*sgn_g - "
     "0.089*g - 0.154*sgn_qd*sgn_g + 7.162*sgn_g + 0.532 + (-0.663*qd + 0.014*g + 1.64*sgn_qd - "
     "4.245*sgn_g - 10.159*sgn_qd - 0.226)*sqrt(abs(0.167*qd - 0.076*g - 0.467*sgn_qd + "
     "2.687*sgn_g))",
     68},
};

TEST(PaperComplexity, CountsThePublishedFormulas) {
  const std::vector<std::string> names = {"qd", "sgn_qd", "g", "sgn_g"};
  for (const PublishedFormula& published : kPublished) {
    EXPECT_EQ(paper_complexity(parse(published.text, names)), published.complexity) << published.id;
  }
}

TEST(PaperComplexity, DoesNotCountConstantsAndUnaryMinus) {
  const std::vector<std::string> names = {"v"};
  EXPECT_EQ(paper_complexity(parse("3.5", names)), 0);
  EXPECT_EQ(paper_complexity(parse("-v", names)), 1);
  EXPECT_EQ(node_count(parse("-v", names)), 2);
  EXPECT_EQ(paper_complexity(parse("2*v + 1", names)), 3);
}

}  // namespace
}  // namespace tribench
