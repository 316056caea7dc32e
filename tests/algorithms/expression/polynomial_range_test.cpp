// SPDX-License-Identifier: MIT
#include "algorithms/expression/polynomial_range.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/random.hpp"

namespace tribench::polynomial_range_test {
namespace {

const std::vector<std::string> kNames = {"v", "g"};

std::vector<Interval> points(const std::vector<double>& values) {
  std::vector<Interval> result;
  for (const double value : values) result.push_back(Interval::point(value));
  return result;
}

// The polynomial's value rounded down and up, by Horner's rule with 300 bits.
Interval value_at(const std::vector<double>& coefficients, double x) {
  mpfr_t sum;
  mpfr_init2(sum, 300);
  mpfr_set_zero(sum, 1);
  for (std::size_t k = coefficients.size(); k-- > 0;) {
    mpfr_mul_d(sum, sum, x, MPFR_RNDN);
    mpfr_add_d(sum, sum, coefficients[k], MPFR_RNDN);
  }
  const Interval value{mpfr_get_d(sum, MPFR_RNDD), mpfr_get_d(sum, MPFR_RNDU)};
  mpfr_clear(sum);
  return value;
}

TEST(PolynomialRange, HoldsTheTrueValuesAndHardlyMore) {
  RandomStream random(key_of("polynomial range"));
  for (int k = 0; k < 2000; ++k) {
    std::vector<double> coefficients(3 + random.below(kMaxPolynomialDegree - 2));
    for (double& c : coefficients) c = random.normal();
    const double scale = random.chance(0.5) ? 1 : 30;
    const double a = scale * random.normal();
    const double b = scale * random.normal();
    const Interval x{std::min(a, b), std::max(a, b)};
    const Interval range = polynomial_range(points(coefficients), x);
    Interval seen = value_at(coefficients, x.low);
    constexpr int kSteps = 400;
    for (int i = 0; i <= kSteps; ++i) {
      const double at = i == kSteps ? x.high : x.low + (x.high - x.low) * i / kSteps;
      const Interval value = value_at(coefficients, at);
      ASSERT_LE(range.low, value.high);
      ASSERT_GE(range.high, value.low);
      seen = hull(seen, value);
    }
    // The samples miss an extreme by up to max |p''| h^2 / 8 each.
    double size = 0;
    double power = 1;
    for (const double c : coefficients) {
      size += std::abs(c) * power;
      power *= std::max(std::abs(x.low), std::abs(x.high));
    }
    EXPECT_LE(range.high - range.low, seen.high - seen.low + 1e-3 * size);
  }
}

TEST(PolynomialRange, IsExactWhereAnExtremeIsKnown) {
  // (x^2 - 1)^2 + 1/1024 has its least value at 1 and -1.
  const Interval range = polynomial_range(points({1 + 0x1p-10, 0, -2, 0, 1}), {-2, 2});
  EXPECT_LE(range.low, 0x1p-10);
  EXPECT_GE(range.low, 0x1p-10 - 1e-7);
  EXPECT_GE(range.high, 9 + 0x1p-10);
  EXPECT_LE(range.high, 9 + 0x1p-10 + 1e-13);
  // Monotone: the ends.
  EXPECT_EQ(polynomial_range(points({0, 1, 0, 1}), {-1, 2}), (Interval{-2, 10}));
}

TEST(PolynomialRange, FindsTheLargestPolynomialsOfAFormula) {
  const Expression formula =
      parse("exp(v*v - 2*v + 1) / (g^4/2 - g^2*(g - 1)) + v*g + v^3", kNames);
  std::vector<std::pair<std::size_t, std::size_t>> found;  // variable and degree
  for (const auto& polynomial : polynomials_of(formula)) {
    if (polynomial) found.emplace_back(polynomial->variable, polynomial->degree());
  }
  EXPECT_EQ(found, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 4}}));
}

TEST(PolynomialRange, ReadsCoefficientsThatGiveTheFormulasValues) {
  RandomStream random(key_of("coefficients"));
  const RandomFormulas formulas({Op::add, Op::sub, Op::mul, Op::neg}, 1);
  int checked = 0;
  for (int k = 0; k < 3000; ++k) {
    const Expression formula = formulas.grown(3 + random.below(20), random);
    const auto found = polynomials_of(formula);
    if (!found.back()) continue;
    FormulaBounds bounds(formula);
    const Interval x = Interval::point(random.uniform(-2, 2));
    ASSERT_TRUE(bounds.bound({&x, 1}));
    const Interval value = polynomial_range(found.back()->coefficients, x);
    EXPECT_LE(value.low, bounds.root().range.high);
    EXPECT_GE(value.high, bounds.root().range.low);
    ++checked;
  }
  EXPECT_GT(checked, 500);
}

TEST(PolynomialRange, DecidesNearDoubleRootsInAFewBoxes) {
  const InputBox box = {{-1, 1}};
  for (const char* text : {"1/(v^4 - 2*v^2 + 1.0001)", "1/(16*v^5 - 20*v^3 + 5*v + 1.00001)",
                           "1/(v^8-8*v^7+28*v^6-56*v^5+70*v^4-56*v^3+28*v^2-8*v+1.0001)",
                           "log(1.0000001 - v*(5 - v^2*(20 - 16*v^2)))"}) {
    const SingularityResult result = prove_free(parse(text, kNames), box);
    EXPECT_EQ(result.verdict, Verdict::proved_free) << text;
    EXPECT_LE(result.boxes, 4U) << text;
  }
  const SingularityResult root = prove_free(parse("1/(v^4 - 2*v^2 + 0.9999)", kNames), box);
  EXPECT_EQ(root.verdict, Verdict::refuted);
}

}  // namespace
}  // namespace tribench::polynomial_range_test
