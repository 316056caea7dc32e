// SPDX-License-Identifier: MIT
//
// A suite either is refused with a place, or its laws give problems: as many rows as it asks for,
// finite, inside the box that is said of them. A law here is the sum of its inputs, so that the
// target is about the reader and not about formulas.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "problems/suite/suite_problem.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

constexpr std::size_t kMostRowsDrawn = 2000;  // more are no fault, but take long to draw
constexpr std::size_t kMostProblems = 4;

suite::Law sum_of_inputs(const std::string&, std::span<const std::string>) {
  return [](std::span<const double> point) {
    return std::accumulate(point.begin(), point.end(), 0.0);
  };
}

void expect_inside(const Table& table, const std::vector<Input>& inputs) {
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    for (const double x : table.columns[j]) {
      fuzz::expect(x >= inputs[j].low && x <= inputs[j].high, "a row lies outside the box");
    }
  }
  for (const double y : table.target) fuzz::expect(std::isfinite(y), "a target is not finite");
}

}  // namespace

TRIBENCH_FUZZ_TARGET(suite) {
  suite::Suite read;
  if (!fuzz::reads([&] { read = suite::read_suite(input, "suite.toml"); })) return;
  if (read.problems.size() > kMostProblems) return;
  for (suite::SuiteProblem wanted : read.problems) {
    if (!wanted.file.empty()) continue;
    wanted.rows = std::min(wanted.rows, kMostRowsDrawn);
    wanted.test_rows = std::min(wanted.test_rows, kMostRowsDrawn);
    Problem problem;
    if (!fuzz::reads([&] {
          problem = suite::make_suite_problem(read, wanted, sum_of_inputs, std::nullopt, 1);
        })) {
      continue;
    }
    if (read.standardise) continue;
    expect_inside(problem.stages.front().train, problem.inputs);
    expect_inside(problem.test, problem.inputs);
  }
}
