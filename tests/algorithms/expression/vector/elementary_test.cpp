// SPDX-License-Identifier: MIT
//
// The vector functions against MPFR, and every vector level against the others.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/kernels.hpp"
#include "algorithms/expression/vector/level.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

using MpfrFunction = int (*)(mpfr_t, const mpfr_t, mpfr_rnd_t);

struct Function {
  Op op;
  MpfrFunction reference;
  double low;  // where its results are neither overflowing nor trivial
  double high;
};

const std::array kFunctionsTested = {
    Function{Op::exp, mpfr_exp, -745, 709.7},   Function{Op::log, mpfr_log, 0, 1e3},
    Function{Op::sin, mpfr_sin, -1e4, 1e4},     Function{Op::cos, mpfr_cos, -1e4, 1e4},
    Function{Op::tanh, mpfr_tanh, -20.0, 20.0}, Function{Op::sqrt, mpfr_sqrt, 0, 1e6},
    Function{Op::atan, mpfr_atan, -50, 50},
};

template <typename T>
std::vector<T> apply(Op op, VectorLevel level, const std::vector<T>& x) {
  std::vector<T> y(x.size());
  const auto kernel =
      kernel_table<T>(level).function[static_cast<int>(op) - static_cast<int>(Op::neg)];
  kernel(y.data(), x.data(), nullptr, nullptr, x.size());
  return y;
}

// Distance from the true value in units in the last place of the true value rounded to T.
template <typename T>
double distance(mpfr_t exact, T y) {
  const T rounded = std::is_same_v<T, float> ? static_cast<T>(mpfr_get_flt(exact, MPFR_RNDN))
                                             : static_cast<T>(mpfr_get_d(exact, MPFR_RNDN));
  double error = 0;
  if (std::isnan(rounded) || std::isnan(y)) {
    error = std::isnan(rounded) == std::isnan(y) ? 0 : HUGE_VAL;
  } else if (std::isinf(rounded) || std::isinf(y)) {
    const T limit = std::numeric_limits<T>::max();
    const bool next_to_it = std::abs(rounded) == limit || std::abs(y) == limit;
    error = rounded == y ? 0 : (next_to_it ? 1 : HUGE_VAL);
  } else {
    const T above = std::nextafter(std::abs(rounded), std::numeric_limits<T>::infinity());
    const T below = std::nextafter(std::abs(rounded), T{0});
    T unit = std::isinf(above) ? std::abs(rounded) - below : above - std::abs(rounded);
    mpfr_sub_d(exact, exact, static_cast<double>(y), MPFR_RNDN);
    mpfr_div_d(exact, exact, static_cast<double>(unit), MPFR_RNDN);
    error = std::abs(mpfr_get_d(exact, MPFR_RNDN));
  }
  return error;
}

template <typename T>
double ulp_error(MpfrFunction reference, T x, T y) {
  mpfr_t exact;
  mpfr_t argument;
  mpfr_inits2(160, exact, argument, static_cast<mpfr_ptr>(nullptr));
  mpfr_set_d(argument, static_cast<double>(x), MPFR_RNDN);
  reference(exact, argument, MPFR_RNDN);
  const double error = distance(exact, y);
  mpfr_clears(exact, argument, static_cast<mpfr_ptr>(nullptr));
  return error;
}

template <typename T>
double power_error(T x, T exponent, T y) {
  mpfr_t exact;
  mpfr_t base;
  mpfr_t power;
  mpfr_inits2(160, exact, base, power, static_cast<mpfr_ptr>(nullptr));
  mpfr_set_d(base, static_cast<double>(x), MPFR_RNDN);
  mpfr_set_d(power, static_cast<double>(exponent), MPFR_RNDN);
  mpfr_pow(exact, base, power, MPFR_RNDN);
  const double error = distance(exact, y);
  mpfr_clears(exact, base, power, static_cast<mpfr_ptr>(nullptr));
  return error;
}

// Arguments of a function: its main range, all magnitudes and signs, and every special value.
template <typename T>
std::vector<T> arguments(const Function& function, int count) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  RandomStream random(key_of(op_name(function.op)));
  std::vector<T> x = {T{0},
                      -T{0},
                      std::numeric_limits<T>::infinity(),
                      -std::numeric_limits<T>::infinity(),
                      std::numeric_limits<T>::quiet_NaN(),
                      std::numeric_limits<T>::denorm_min(),
                      -std::numeric_limits<T>::denorm_min(),
                      std::numeric_limits<T>::min(),
                      std::numeric_limits<T>::max(),
                      std::numeric_limits<T>::lowest(),
                      T{1},
                      T{-1},
                      std::nextafter(T{1}, T{0}),
                      std::nextafter(T{1}, T{2})};
  for (int k = 1; k < 2000; ++k) {  // next to the zeros of sin and cos, and where n changes
    x.push_back(static_cast<T>(k * 1.5707963267948966));
    x.push_back(static_cast<T>((k - 1000) * 0.34657359027997264));
  }
  for (int i = 0; i < count; ++i) {
    x.push_back(static_cast<T>(random.uniform(function.low, function.high)));
    x.push_back(static_cast<T>(random.normal()));
    x.push_back(static_cast<T>(1 + 0.3 * random.normal() * std::exp(-30 * random.uniform())));
    x.push_back(std::bit_cast<T>(static_cast<Bits>(random.next())));
  }
  return x;
}

template <typename T>
class ElementaryFunctions : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(ElementaryFunctions, Scalars);

TYPED_TEST(ElementaryFunctions, AreWithinTwoUnitsInTheLastPlaceOfTheTrueValue) {
  for (const Function& function : kFunctionsTested) {
    const std::vector<TypeParam> x = arguments<TypeParam>(function, 20000);
    const std::vector<TypeParam> y = apply(function.op, vector_level(), x);
    double worst = 0;
    TypeParam where = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double error = ulp_error(function.reference, x[i], y[i]);
      if (error > worst) {
        worst = error;
        where = x[i];
      }
    }
    EXPECT_LE(worst, 2.0) << op_name(function.op) << " at " << std::hexfloat << where;
    this->RecordProperty(std::string(op_name(function.op)) + "_worst_ulp", std::to_string(worst));
  }
}

TYPED_TEST(ElementaryFunctions, GiveTheSameBitsOnEveryVectorLevel) {
  for (const Function& function : kFunctionsTested) {
    const std::vector<TypeParam> x = arguments<TypeParam>(function, 20000);
    const std::vector<TypeParam> first = apply(function.op, VectorLevel::baseline, x);
    for (const VectorLevel level : available_vector_levels()) {
      const std::vector<TypeParam> y = apply(function.op, level, x);
      for (std::size_t i = 0; i < x.size(); ++i) {
        ASSERT_TRUE(y[i] == first[i] || (std::isnan(y[i]) && std::isnan(first[i])))
            << op_name(function.op) << ' ' << vector_level_name(level) << " at " << std::hexfloat
            << x[i] << ": " << y[i] << ", not " << first[i];
        ASSERT_EQ(std::signbit(y[i]) && !std::isnan(y[i]),
                  std::signbit(first[i]) && !std::isnan(first[i]));
      }
    }
  }
}

// Quotients next to the middle between two numbers of T, all magnitudes, significands of ones.
template <typename T>
void hard_quotients(int count, std::vector<T>& a, std::vector<T>& b) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  RandomStream random(key_of("quotients"));
  const T ulp = std::numeric_limits<T>::epsilon();
  for (int i = 0; i < count; ++i) {
    const T divisor = 1 + static_cast<T>(random.uniform());
    const T quotient = 1 + static_cast<T>(random.uniform());
    T dividend = std::fma(divisor, quotient, divisor * (ulp / 2));  // quotient + half an ulp
    for (int step = static_cast<int>(random.below(3)); step > 0; --step) {
      dividend = std::nextafter(dividend, T{0});
    }
    a.push_back(dividend);
    b.push_back(divisor);
    a.push_back(std::bit_cast<T>(static_cast<Bits>(random.next())));
    b.push_back(std::bit_cast<T>(static_cast<Bits>(random.next())));
    a.push_back(i % 2 == 0 ? dividend : T{1});
    b.push_back(2 - static_cast<T>(random.below(3)) * ulp);
    a.push_back(static_cast<T>(random.normal()));
    b.push_back(static_cast<T>(random.normal()));
  }
}

TYPED_TEST(ElementaryFunctions, DivideAsIeeeSaysOnEveryLevel) {
  using T = TypeParam;
  std::vector<T> a;
  std::vector<T> b;
  hard_quotients(250000, a, b);
  std::vector<T> out(a.size());
  for (const VectorLevel level : available_vector_levels()) {
    kernel_table<T>(level).binary[3][kFormVV](out.data(), a.data(), b.data(), nullptr, a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      const T expected = a[i] / b[i];
      ASSERT_TRUE(out[i] == expected || (std::isnan(out[i]) && std::isnan(expected)))
          << std::hexfloat << a[i] << " / " << b[i] << ": " << out[i];
    }
  }
}

TYPED_TEST(ElementaryFunctions, KeepTheSignOfZeroAndTheExactPoints) {
  using T = TypeParam;
  for (const VectorLevel level : available_vector_levels()) {
    for (const Op op : {Op::sin, Op::tanh, Op::atan, Op::sqrt}) {
      const std::vector<T> y = apply(op, level, std::vector<T>{T{0}, -T{0}});
      EXPECT_FALSE(std::signbit(y[0])) << op_name(op);
      EXPECT_TRUE(std::signbit(y[1])) << op_name(op);
    }
    EXPECT_EQ(apply(Op::exp, level, std::vector<T>{0})[0], 1);
    EXPECT_EQ(apply(Op::cos, level, std::vector<T>{0})[0], 1);
    EXPECT_EQ(apply(Op::log, level, std::vector<T>{1})[0], 0);
    EXPECT_FALSE(std::signbit(apply(Op::log, level, std::vector<T>{1})[0]));
    EXPECT_EQ(apply(Op::tanh, level, std::vector<T>{30})[0], 1);
    EXPECT_EQ(apply(Op::sgn, level, std::vector<T>{-3})[0], -1);
  }
}

TYPED_TEST(ElementaryFunctions, StayWithinMinusOneAndOneWhereTheTrueValueDoes) {
  using T = TypeParam;
  for (const Op op : {Op::sin, Op::cos, Op::tanh}) {
    std::vector<T> x;
    for (int k = -2000; k < 2000; ++k) {
      T near = static_cast<T>(k * 1.5707963267948966);
      for (int step = 0; step < 8; ++step) {
        x.push_back(near);
        near = std::nextafter(near, std::numeric_limits<T>::infinity());
      }
    }
    for (const T y : apply(op, vector_level(), x)) ASSERT_LE(std::abs(y), 1) << op_name(op);
  }
}

// Bases and exponents: what formulas hold, all bit patterns, results next to overflow and
// underflow, bases next to 1 with huge exponents, and every special value with every other.
template <typename T>
void powers(int count, std::vector<T>& x, std::vector<T>& y) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  RandomStream random(key_of("powers"));
  const T huge = std::numeric_limits<T>::max();
  const T infinity = std::numeric_limits<T>::infinity();
  const std::vector<T> special = {T{0},
                                  T{1},
                                  T{2},
                                  T{3},
                                  T(0.5),
                                  T(1.5),
                                  T(1e9),
                                  std::numeric_limits<T>::denorm_min(),
                                  std::numeric_limits<T>::min(),
                                  huge,
                                  infinity,
                                  std::nextafter(T{1}, T{0}),
                                  T(9007199254740991),
                                  T(9007199254740992),
                                  std::numeric_limits<T>::quiet_NaN()};
  for (const T a : special) {
    for (const T b : special) {
      for (const int signs : {0, 1, 2, 3}) {
        x.push_back((signs & 1) != 0 ? -a : a);
        y.push_back((signs & 2) != 0 ? -b : b);
      }
    }
  }
  const auto add = [&](double a, double b) {
    x.push_back(static_cast<T>(a));
    y.push_back(static_cast<T>(b));
  };
  const double reach = std::log(static_cast<double>(huge));
  for (int i = 0; i < count; ++i) {
    add(random.uniform(0, 10), random.uniform(-5, 5));
    add(std::exp(random.uniform(-1, 1)), random.normal() * 20);
    const double base = std::exp(random.uniform(-reach, reach));
    add(base, random.uniform(-1.1, 1.1) * reach / std::log(base));
    const double near = 1 + random.normal() * std::exp(-30 * random.uniform());
    add(near, random.uniform(-1.1, 1.1) * reach / std::log(std::abs(near)));
    add(-random.uniform(0, 10), static_cast<double>(random.below(40)) - 20);
    x.push_back(std::bit_cast<T>(static_cast<Bits>(random.next())));
    y.push_back(std::bit_cast<T>(static_cast<Bits>(random.next())));
  }
}

TYPED_TEST(ElementaryFunctions, RaiseToAPowerWithinAUnitInTheLastPlaceAndTheSameBitsOnEveryLevel) {
  using T = TypeParam;
  std::vector<T> x;
  std::vector<T> y;
  powers<T>(20000, x, y);
  std::vector<T> first(x.size());
  kernel_table<T>(VectorLevel::baseline)
      .power[kFormVV](first.data(), x.data(), y.data(), nullptr, x.size());
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double error = power_error(x[i], y[i], first[i]);
    ASSERT_LE(error, 1.0) << std::hexfloat << x[i] << " ^ " << y[i] << ": " << first[i];
    worst = std::max(worst, error);
    ASSERT_TRUE(first[i] != 0 || std::signbit(first[i]) == std::signbit(std::pow(x[i], y[i])))
        << std::hexfloat << x[i] << " ^ " << y[i];
  }
  this->RecordProperty("pow_worst_ulp", std::to_string(worst));
  std::vector<T> out(x.size());
  for (const VectorLevel level : available_vector_levels()) {
    kernel_table<T>(level).power[kFormVV](out.data(), x.data(), y.data(), nullptr, x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      ASSERT_TRUE(out[i] == first[i] || (std::isnan(out[i]) && std::isnan(first[i])))
          << vector_level_name(level) << ' ' << std::hexfloat << x[i] << " ^ " << y[i];
    }
  }
}

TYPED_TEST(ElementaryFunctions, GivePowersThatAreNumbersExactly) {
  using T = TypeParam;
  std::vector<T> x;
  std::vector<T> y;
  std::vector<T> expected;
  for (int base = 2; base <= 12; ++base) {
    T product = 1;
    for (int n = 0; product < T{1} / std::numeric_limits<T>::epsilon(); ++n, product *= base) {
      x.push_back(static_cast<T>(base));
      y.push_back(static_cast<T>(n));
      expected.push_back(product);
      x.push_back(product);
      y.push_back(T(0.5));
      expected.push_back(std::sqrt(product));
    }
  }
  std::vector<T> out(x.size());
  kernel_table<T>(vector_level()).power[kFormVV](out.data(), x.data(), y.data(), nullptr, x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_EQ(out[i], expected[i]) << x[i] << " ^ " << y[i];
  }
}

}  // namespace
}  // namespace tribench
