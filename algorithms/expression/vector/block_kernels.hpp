// SPDX-License-Identifier: MIT
//
// The kernels of kernels.hpp as templates over the width that the including translation unit is
// compiled for, and the table of them. Only kernels_<level>.cpp include this.
#pragma once

#include <utility>

#include "algorithms/expression/vector/elementary_float.hpp"
#include "algorithms/expression/vector/kernels.hpp"

namespace tribench {
namespace {

// How quotients are formed: by the divider, or with two vectors in three by multiplications (the
// same bits either way).
enum class Division { hardware, mixed };

struct ByDivider {
  template <typename V>
  static V divide(V a, V b) {
    return a / b;
  }
};
struct ByMultiplying {
  template <typename V>
  static V divide(V a, V b) {
    return divide_by_multiplying(a, b);
  }
};

template <typename T>
struct ReadWhole {
  Vector<T> operator()(const T* p) const { return load<Vector<T>>(p); }
};
template <typename T>
struct ReadPart {
  std::size_t count;
  Vector<T> operator()(const T* p) const { return load_part(p, count); }
};

// out[i] = f(i-th vector), a few vectors a turn, the rest masked. f takes what reads an operand,
// the row, and what divides.
template <bool Mixed, typename T, typename F>
inline void for_rows(T* out, std::size_t n, F f) {
  constexpr std::size_t kStep = kWidth<T>;
  constexpr std::size_t kTurn = Mixed && sizeof(T) == sizeof(double) ? 3 : 2;
  const ReadWhole<T> whole;
  std::size_t i = 0;
  for (; i + kTurn * kStep <= n; i += kTurn * kStep) {
    const Vector<T> first = f(whole, i, ByDivider{});
    if constexpr (Mixed) {
      const Vector<T> second = f(whole, i + kStep, ByMultiplying{});
      store(out + i + kStep, second);
      if constexpr (kTurn == 3) {
        store(out + i + 2 * kStep, f(whole, i + 2 * kStep, ByMultiplying{}));
      }
    } else {
      const Vector<T> second = f(whole, i + kStep, ByDivider{});
      store(out + i + kStep, second);
    }
    store(out + i, first);
  }
  for (; i + kStep <= n; i += kStep) store(out + i, f(whole, i, ByDivider{}));
  if (i < n) store_part(out + i, f(ReadPart<T>{n - i}, i, ByDivider{}), n - i);
}

template <int Op, typename Divider, typename V>
inline V basic(V a, V b) {
  if constexpr (Op == 0) return a + b;
  if constexpr (Op == 1) return a - b;
  if constexpr (Op == 2) return a * b;
  if constexpr (Op == 3) return Divider::divide(a, b);
}

template <int Outer, typename Divider, typename V>
inline V outer(V inner, V c) {
  if constexpr (Outer == kOuterSubFrom) return c - inner;
  if constexpr (Outer == kOuterDivInto) return Divider::divide(c, inner);
  if constexpr (Outer < kBasicOps) return basic<Outer, Divider>(inner, c);
}

template <typename T, Division Quotients, int Op, int Form>
void binary_kernel(T* out, const T* a, const T* b, const T*, std::size_t n) {
  constexpr bool kMixed = Quotients == Division::mixed && Op == 3;
  const Vector<T> sa = Form == kFormSV ? splat(*a) : Vector<T>{};
  const Vector<T> sb = Form == kFormVS ? splat(*b) : Vector<T>{};
  for_rows<kMixed>(out, n, [=](auto read, std::size_t i, auto divider) {
    Vector<T> x = sa;
    Vector<T> y = sb;
    if constexpr (Form != kFormSV) x = read(a + i);
    if constexpr (Form != kFormVS) y = read(b + i);
    return basic<Op, decltype(divider)>(x, y);
  });
}

template <typename T, Division Quotients, int Op, int Form, int Outer, bool ScalarC>
void pair_kernel(T* out, const T* a, const T* b, const T* c, std::size_t n) {
  constexpr bool kDivides = Op == 3 || Outer == kOuterDiv || Outer == kOuterDivInto;
  constexpr bool kMixed = Quotients == Division::mixed && kDivides;
  const Vector<T> sa = Form == kFormSV ? splat(*a) : Vector<T>{};
  const Vector<T> sb = Form == kFormVS ? splat(*b) : Vector<T>{};
  const Vector<T> sc = ScalarC ? splat(*c) : Vector<T>{};
  for_rows<kMixed>(out, n, [=](auto read, std::size_t i, auto divider) {
    Vector<T> x = sa;
    Vector<T> y = sb;
    Vector<T> z = sc;
    if constexpr (Form != kFormSV) x = read(a + i);
    if constexpr (Form != kFormVS) y = read(b + i);
    if constexpr (!ScalarC) z = read(c + i);
    return outer<Outer, decltype(divider)>(basic<Op, decltype(divider)>(x, y), z);
  });
}

template <typename V>
inline V signum(V x) {
  const V zero{};
  const V one = zero + 1;
  V result = x > zero ? one : x;  // NaN stays
  result = x < zero ? -one : result;
  return x == zero ? zero : result;
}

template <int Function, typename V>
inline V apply(V x) {
  if constexpr (Function == 0) return -x;
  if constexpr (Function == 1) return exp(x);
  if constexpr (Function == 2) return log(x);
  if constexpr (Function == 3) return sqrt(x);
  if constexpr (Function == 4) return abs(x);
  if constexpr (Function == 5) return signum(x);
  if constexpr (Function == 6) return sin(x);
  if constexpr (Function == 7) return cos(x);
  if constexpr (Function == 8) return tanh(x);
  if constexpr (Function == 9) return atan(x);
}

template <typename T, int Function>
void function_kernel(T* out, const T* a, const T*, const T*, std::size_t n) {
  for_rows<false>(out, n,
                  [=](auto read, std::size_t i, auto) { return apply<Function>(read(a + i)); });
}

template <typename T>
void integer_power_kernel(T* out, const T* a, const T* b, const T*, std::size_t n) {
  const int exponent = static_cast<int>(*b);
  const bool inverted = exponent < 0;
  const unsigned size =
      inverted ? 0U - static_cast<unsigned>(exponent) : static_cast<unsigned>(exponent);
  for_rows<false>(out, n, [=](auto read, std::size_t i, auto) {
    Vector<T> square = read(a + i);
    Vector<T> result = splat(T{1});
    for (unsigned m = size; m != 0; m >>= 1) {
      if ((m & 1U) != 0) result = result * square;
      square = square * square;
    }
    return inverted ? splat(T{1}) / result : result;
  });
}

template <typename T, int Form>
void power_kernel(T* out, const T* a, const T* b, const T*, std::size_t n) {
  const Vector<T> sa = Form == kFormSV ? splat(*a) : Vector<T>{};
  const Vector<T> sb = Form == kFormVS ? splat(*b) : Vector<T>{};
  for_rows<false>(out, n, [=](auto read, std::size_t i, auto) {
    Vector<T> x = sa;
    Vector<T> y = sb;
    if constexpr (Form != kFormSV) x = read(a + i);
    if constexpr (Form != kFormVS) y = read(b + i);
    return pow(x, y);
  });
}

template <typename T>
void copy_kernel(T* out, const T* a, const T*, const T*, std::size_t n) {
  for_rows<false>(out, n, [=](auto read, std::size_t i, auto) { return read(a + i); });
}

template <typename T>
void fill_kernel(T* out, const T* a, const T*, const T*, std::size_t n) {
  const Vector<T> s = splat(*a);
  for_rows<false>(out, n, [=](auto, std::size_t, auto) { return s; });
}

constexpr std::size_t kSums = 16;

// error_at(i): the errors of the lanes from row i on.
template <typename T, typename ErrorAt>
void add_squares(double* sums, const T* a, const T* b, std::size_t n, const ErrorAt& error_at) {
  constexpr std::size_t kParts = kSums / kWidth<double>;
  F64 total[kParts];
  for (std::size_t p = 0; p < kParts; ++p) total[p] = load<F64>(sums + p * kWidth<double>);
  std::size_t i = 0;
  for (; i + kSums <= n; i += kSums) {
    for (std::size_t p = 0; p < kParts; ++p) {
      const F64 error = error_at(i + p * kWidth<double>);
      total[p] = total[p] + error * error;
    }
  }
  for (std::size_t p = 0; p < kParts; ++p) store(sums + p * kWidth<double>, total[p]);
  for (std::size_t lane = 0; i < n; ++i, ++lane) {
    const double error = a[i] - b[i];
    sums[lane] = sums[lane] + error * error;
  }
}

inline void add_errors(double* sums, const double* a, const double* b, std::size_t n) {
  add_squares(sums, a, b, n, [&](std::size_t at) { return load<F64>(a + at) - load<F64>(b + at); });
}

// Errors are taken in float, their squares summed in double.
inline void add_errors(double* sums, const float* a, const float* b, std::size_t n) {
  using Half = float __attribute__((vector_size(kLaneBytes / 2)));
  add_squares(sums, a, b, n, [&](std::size_t at) {
    return __builtin_convertvector(load<Half>(a + at) - load<Half>(b + at), F64);
  });
}

template <typename T>
void add_squared_errors_kernel(double* sums, const T* a, const T* b, std::size_t n) {
  add_errors(sums, a, b, n);
}

template <typename T, Division Quotients, int Op, int Form, int Outer>
constexpr void set_pair(KernelTable<T>& table) {
  table.pair[Op][Form][Outer][0] = pair_kernel<T, Quotients, Op, Form, Outer, false>;
  table.pair[Op][Form][Outer][1] = pair_kernel<T, Quotients, Op, Form, Outer, true>;
}

template <typename T, Division Quotients, int Op, int Form>
constexpr void set_binary(KernelTable<T>& table) {
  // a + s and a * s are s + a and s * a.
  constexpr bool kMirrored = Form == kFormSV && (Op == 0 || Op == 2);
  if constexpr (!kMirrored) {
    table.binary[Op][Form] = binary_kernel<T, Quotients, Op, Form>;
    set_pair<T, Quotients, Op, Form, kOuterAdd>(table);
    set_pair<T, Quotients, Op, Form, kOuterSub>(table);
    set_pair<T, Quotients, Op, Form, kOuterMul>(table);
    set_pair<T, Quotients, Op, Form, kOuterDiv>(table);
    set_pair<T, Quotients, Op, Form, kOuterSubFrom>(table);
    set_pair<T, Quotients, Op, Form, kOuterDivInto>(table);
  }
}

template <typename T, Division Quotients, int Op>
constexpr void set_forms(KernelTable<T>& table) {
  set_binary<T, Quotients, Op, kFormVV>(table);
  set_binary<T, Quotients, Op, kFormVS>(table);
  set_binary<T, Quotients, Op, kFormSV>(table);
}

template <typename T, Division Quotients = Division::hardware>
constexpr KernelTable<T> make_kernel_table() {
  KernelTable<T> table{};
  set_forms<T, Quotients, 0>(table);
  set_forms<T, Quotients, 1>(table);
  set_forms<T, Quotients, 2>(table);
  set_forms<T, Quotients, 3>(table);
  [&table]<int... Function>(std::integer_sequence<int, Function...>) {
    ((table.function[Function] = function_kernel<T, Function>), ...);
  }
  (std::make_integer_sequence<int, kFunctions>{});
  table.integer_power = integer_power_kernel<T>;
  table.power[kFormVV] = power_kernel<T, kFormVV>;
  table.power[kFormVS] = power_kernel<T, kFormVS>;
  table.power[kFormSV] = power_kernel<T, kFormSV>;
  table.copy = copy_kernel<T>;
  table.fill = fill_kernel<T>;
  table.add_squared_errors = add_squared_errors_kernel<T>;
  return table;
}

}  // namespace
}  // namespace tribench
