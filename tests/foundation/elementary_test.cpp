// SPDX-License-Identifier: MIT
//
// The functions of one number. Their accuracy against MPFR is tested with the vector functions
// that they are (tests/algorithms/expression/vector/elementary_test.cpp).
#include "foundation/elementary.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "foundation/elementary/column.hpp"
#include "foundation/elementary/scalar.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

// All magnitudes and signs, and the special points.
std::vector<double> arguments() {
  RandomStream random(key_of("elementary"));
  std::vector<double> x = {0, -0.0, 1, -1, HUGE_VAL, -HUGE_VAL, NAN, 5e-324, 2.2e-308, 1.7e308};
  for (int i = 0; i < 20000; ++i) {
    x.push_back(random.uniform(-30, 30));
    x.push_back(std::bit_cast<double>(random.next()));
  }
  return x;
}

std::uint64_t bits_of(double x) {
  return std::isnan(x) ? 0x7ff8000000000000 : std::bit_cast<std::uint64_t>(x);
}

std::vector<std::uint64_t> results(const elementary::ScalarTable& table) {
  std::vector<std::uint64_t> bits;
  for (const double x : arguments()) {
    for (const auto function :
         {table.exp, table.log, table.sin, table.cos, table.tanh, table.atan}) {
      bits.push_back(bits_of(function(x)));
    }
    for (const double y : {0.5, 1.7, -3.3, 40.0}) bits.push_back(bits_of(table.pow(x, y)));
  }
  return bits;
}

TEST(Elementary, GivesTheSameBitsOnEveryMachine) {
  const std::vector<std::uint64_t> bits = results(elementary::kScalarBaseline);
  // What this gave where it was written; a processor or a compiler that gives other bits is found
  // here and not in a result.
  std::uint64_t hash = 0;
  for (const std::uint64_t each : bits) hash = (hash ^ each) * 0x100000001b3 + (hash >> 31);
  EXPECT_EQ(hash, 10442152217530318270U);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    EXPECT_EQ(bits, results(elementary::kScalarFma));
  }
#endif
}

// A column of any length, and so the last, part-filled register, gives what one number at a time
// does.
void expect_columns(const elementary::ColumnTable& column, const elementary::ScalarTable& scalar) {
  using Function = std::function<double(double)>;
  using ColumnFunction = std::function<void(double*, std::size_t)>;
  std::vector<std::pair<ColumnFunction, Function>> functions = {{column.exp, scalar.exp},
                                                                {column.sin, scalar.sin},
                                                                {column.cos, scalar.cos},
                                                                {column.tanh, scalar.tanh}};
  for (const double y : {0.5, 1.7, -3.0}) {
    functions.push_back({[&column, y](double* x, std::size_t n) { column.pow(x, n, y); },
                         [&scalar, y](double x) { return scalar.pow(x, y); }});
  }
  const std::vector<double> x = arguments();
  for (std::size_t k = 0; k < functions.size(); ++k) {
    for (const std::size_t length : {std::size_t{1}, std::size_t{2}, std::size_t{7}, x.size()}) {
      std::vector<double> y(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(length));
      functions[k].first(y.data(), length);
      for (std::size_t i = 0; i < length; ++i) {
        ASSERT_EQ(bits_of(y[i]), bits_of(functions[k].second(x[i]))) << k << " of " << x[i];
      }
    }
  }
}

TEST(Elementary, GivesAColumnTheBitsOfItsNumbers) {
  expect_columns(elementary::kColumnBaseline, elementary::kScalarBaseline);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    expect_columns(elementary::kColumnFma, elementary::kScalarFma);
  }
#endif
}

double relative(double value, double expected) {
  if (value == expected || (std::isnan(value) && std::isnan(expected))) return 0;
  return std::abs(value - expected) / std::abs(expected);
}

TEST(Elementary, AgreesWithTheCLibraryToItsAccuracy) {
  constexpr double kFourUlps = 4 * std::numeric_limits<double>::epsilon();
  for (const double x : arguments()) {
    EXPECT_LE(relative(elementary::log1p(x), std::log1p(x)), kFourUlps) << x;
    EXPECT_LE(relative(elementary::expm1(x), std::expm1(x)), 2 * kFourUlps) << x;
    EXPECT_LE(relative(elementary::atanh(x), std::atanh(x)), 2 * kFourUlps) << x;
    EXPECT_LE(relative(elementary::atanh(x / 31), std::atanh(x / 31)), 2 * kFourUlps) << x;
    if (x > 0) EXPECT_LE(relative(elementary::log10(x), std::log10(x)), kFourUlps) << x;
    EXPECT_LE(relative(elementary::tan(x), std::tan(x)), kFourUlps) << x;
    EXPECT_LE(relative(elementary::cosh(x), std::cosh(x)), 1e-14) << x;
    if (std::abs(x) > 0.5) EXPECT_LE(relative(elementary::sinh(x), std::sinh(x)), 1e-14) << x;
  }
  for (double x = 0.01; x < 1e4; x *= 1.01) {
    EXPECT_NEAR(elementary::lgamma(x), std::lgamma(x), 1e-14 * (1 + std::abs(std::lgamma(x)))) << x;
  }
}

TEST(Elementary, CountsPowersOfTenAsWhole) {
  for (int n = -20; n <= 22; ++n) {
    const double power = std::stod("1e" + std::to_string(n));
    EXPECT_EQ(elementary::log10(power), n);
  }
}

TEST(Elementary, KeepsItsLimits) {
  EXPECT_EQ(elementary::log1p(-1), -HUGE_VAL);
  EXPECT_EQ(elementary::log1p(HUGE_VAL), HUGE_VAL);
  EXPECT_TRUE(std::isnan(elementary::log1p(-2)));
  EXPECT_NEAR(elementary::lgamma(1), 0, 1e-14);
  EXPECT_TRUE(std::isnan(elementary::lgamma(-0.5)));
  EXPECT_EQ(elementary::lgamma(HUGE_VAL), HUGE_VAL);
}

}  // namespace
}  // namespace tribench
