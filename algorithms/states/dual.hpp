// SPDX-License-Identifier: MIT
//
// A number with its derivatives by N others: forward differentiation of the laws, so that the
// sensitivities of a state come from the code that integrates it. Values have the bits that doubles
// alone would have.
#pragma once

#include <array>
#include <cstddef>

namespace tribench::states {

double exponential(double x);

template <std::size_t N>
struct Dual {
  double value = 0;
  std::array<double, N> by{};

  Dual() = default;
  Dual(double x) : value(x) {}  // NOLINT: a number is one that depends on nothing

  // d f(x) of slope f'.
  Dual chain(double result, double slope) const {
    Dual y(result);
    for (std::size_t i = 0; i < N; ++i) y.by[i] = slope * by[i];
    return y;
  }

  friend Dual operator-(const Dual& a) { return a.chain(-a.value, -1); }
  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual y(a.value + b.value);
    for (std::size_t i = 0; i < N; ++i) y.by[i] = a.by[i] + b.by[i];
    return y;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual y(a.value - b.value);
    for (std::size_t i = 0; i < N; ++i) y.by[i] = a.by[i] - b.by[i];
    return y;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual y(a.value * b.value);
    for (std::size_t i = 0; i < N; ++i) y.by[i] = a.by[i] * b.value + a.value * b.by[i];
    return y;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    Dual y(a.value / b.value);
    for (std::size_t i = 0; i < N; ++i) y.by[i] = (a.by[i] - y.value * b.by[i]) / b.value;
    return y;
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend Dual exponential(const Dual& x) {
    const double e = exponential(x.value);
    return x.chain(e, e);
  }
};

}  // namespace tribench::states
