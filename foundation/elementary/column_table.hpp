// SPDX-License-Identifier: MIT
//
// The table of column.hpp from the vector functions.
#pragma once

#include "foundation/elementary/column.hpp"
#include "foundation/elementary/power.hpp"

namespace tribench {
namespace {

template <typename Function>
void replace_each(double* x, std::size_t n, Function function) {
  constexpr std::size_t kStep = kWidth<double>;
  std::size_t i = 0;
  for (; i + kStep <= n; i += kStep) store(x + i, function(load<F64>(x + i)));
  if (i < n) store_part(x + i, function(load_part(x + i, n - i)), n - i);
}

template <F64 (*function)(F64)>
void replace(double* x, std::size_t n) {
  replace_each(x, n, function);
}

void replace_by_power(double* x, std::size_t n, double y) {
  replace_each(x, n, [y = splat(y)](F64 lanes) { return pow(lanes, y); });
}

constexpr elementary::ColumnTable kColumnTable = {replace<exp>, replace<sin>, replace<cos>,
                                                  replace<tanh>, replace_by_power};

}  // namespace
}  // namespace tribench
