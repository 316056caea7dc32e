// SPDX-License-Identifier: MIT
#include "algorithms/parfam/denominators.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "foundation/random.hpp"

namespace tribench::parfam {
namespace {

TEST(Denominators, AreOnePlusTheirPolynomial) {
  // exp(x / (1 + 0.5 x)) / (1 + 2 x g) at x = 0.4.
  Structure structure;
  structure.inputs = 1;
  structure.functions = {Op::exp};
  structure.numerators = {{{1}}};
  structure.denominators = {{{1}}};
  structure.out_numerator = {{0, 1}};
  structure.out_denominator = {{1, 1}};
  ASSERT_EQ(count_denominators(structure), 2U);
  const std::vector<double> inner = {1, 0.5, 2};
  const std::vector<double> point = {0.4};
  std::vector<double> values(2);
  denominators_at(structure, inner, point, values, {});
  EXPECT_DOUBLE_EQ(values[0], 1.2);
  EXPECT_DOUBLE_EQ(values[1], 1 + 2 * 0.4 * std::exp(0.4 / 1.2));
}

TEST(Denominators, HaveTheSlopesOfFiniteDifferences) {
  RandomStream random(8);
  GridLimits limits = small_grid();
  limits.base_functions = {Op::sqrt, Op::cos, Op::exp, Op::tanh};
  limits.functions = 2;
  int compared = 0;
  for (const Family& family : published_grid(limits)) {
    const std::vector<int> caps(2, kMaximalPotence);
    const Structure structure = make_structure(family, caps);
    const std::size_t count = count_denominators(structure);
    if (count == 0) continue;
    const std::size_t n = structure.inner_parameters() + structure.out_denominator.size();
    std::vector<double> inner(n);
    for (double& value : inner) value = 0.2 * random.normal();
    const std::vector<double> point = {random.uniform(0.2, 1), random.uniform(-1, -0.2)};
    std::vector<double> values(count);
    std::vector<double> jacobian(count * n);
    denominators_at(structure, inner, point, values, jacobian);
    const std::size_t k = random.below(n);
    const auto at = [&](double step) {
      std::vector<double> moved = inner;
      moved[k] += step;
      std::vector<double> result(count);
      denominators_at(structure, moved, point, result, {});
      return result;
    };
    const std::vector<double> above = at(1e-6);
    const std::vector<double> below = at(-1e-6);
    for (std::size_t i = 0; i < count; ++i) {
      const double slope = (above[i] - below[i]) / 2e-6;
      EXPECT_NEAR(jacobian[i * n + k], slope, 1e-5 * (1 + std::abs(slope))) << describe(family);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace tribench::parfam
