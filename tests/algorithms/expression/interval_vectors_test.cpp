// SPDX-License-Identifier: MIT
//
// The interval arithmetic on cases that nobody here wrote (ITF1788, beside the checkout as
// ../shared/suites/interval_vectors): every result holds the expected one, and a floor for the
// share that is the tightest.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "algorithms/expression/interval.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

struct Share {
  int cases = 0;
  int tightest = 0;
};

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

DecoratedInterval operand(const std::string& low, const std::string& high,
                          const std::string& decoration) {
  return {{number(low), number(high)},
          decoration == "trv" ? Decoration::trivial : Decoration::common};
}

// Nothing where formulas have no such operation.
std::optional<DecoratedInterval> result_of(const std::vector<std::string>& field) {
  static const std::map<std::string, Op> kUnary = {
      {"neg", Op::neg},   {"exp", Op::exp}, {"log", Op::log},  {"sin", Op::sin},  {"cos", Op::cos},
      {"tanh", Op::tanh}, {"abs", Op::abs}, {"sign", Op::sgn}, {"sqrt", Op::sqrt}};
  static const std::map<std::string, Op> kBinary = {
      {"add", Op::add}, {"sub", Op::sub}, {"mul", Op::mul}, {"div", Op::div}, {"pow", Op::pow}};
  const DecoratedInterval a = operand(field[1], field[2], field[3]);
  if (const auto op = kUnary.find(field[0]); op != kUnary.end()) return apply(op->second, a);
  if (field[0] == "sqr") return integer_power(a, 2);
  if (field[0] == "pown") return integer_power(a, std::atoi(field[7].c_str()));
  if (field[0] == "recip") return apply(Op::div, {Interval::point(1)}, a);
  if (const auto op = kBinary.find(field[0]); op != kBinary.end()) {
    return apply(op->second, a, operand(field[4], field[5], field[6]));
  }
  return std::nullopt;
}

TEST(IntervalVectors, AreAllHeldAndMostlyTight) {
  const auto folder = testing::shared_suite("interval_vectors");
  if (!folder) GTEST_SKIP() << "no interval vectors: ../shared/suites is not beside the checkout";
  std::ifstream in(*folder / "vectors.csv");
  std::string line;
  std::getline(in, line);
  std::map<std::string, Share> shares;
  int empty = 0;
  int without = 0;
  while (std::getline(in, line)) {
    std::vector<std::string> field(12);
    std::istringstream parts(line);
    for (std::string& each : field) std::getline(parts, each, ',');
    const auto is_none = [](const std::string& text) { return text == "empty" || text == "nai"; };
    if (is_none(field[1]) || is_none(field[4])) {
      ++empty;  // no box of a proof is
      continue;
    }
    const auto result = result_of(field);
    if (!result) {
      ++without;
      continue;
    }
    Share& share = shares[field[0]];
    ++share.cases;
    // Where the operation is not defined everywhere a proof fails, whatever the range. Not so for
    // powers: ours have whole exponents of any base, and 0^0 is 1.
    if (field[0] != "pow" && (is_none(field[8]) || field[10] == "trv")) {
      EXPECT_EQ(result->decoration, Decoration::trivial) << line;
    }
    if (is_none(field[8])) {
      ++share.tightest;
      continue;
    }
    const Interval expected{number(field[8]), number(field[9])};
    EXPECT_LE(result->range.low, expected.low) << line;
    EXPECT_GE(result->range.high, expected.high) << line;
    share.tightest += result->range == expected ? 1 : 0;
  }
  Share all;
  for (const auto& [op, share] : shares) {
    std::printf("%-5s %5d cases, %5d tightest\n", op.c_str(), share.cases, share.tightest);
    all.cases += share.cases;
    all.tightest += share.tightest;
  }
  std::printf("all   %5d cases, %5d tightest; %d with an empty operand, %d of min and max\n",
              all.cases, all.tightest, empty, without);
  EXPECT_EQ(all.cases + empty + without, 2466);
  for (const char* exact : {"neg", "add", "sub", "mul", "abs", "sign"}) {
    EXPECT_EQ(shares[exact].tightest, shares[exact].cases) << exact;
  }
}

}  // namespace
}  // namespace tribench
