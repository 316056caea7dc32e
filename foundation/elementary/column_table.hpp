// SPDX-License-Identifier: MIT
//
// The table of column.hpp from the vector functions.
#pragma once

#include "foundation/elementary/column.hpp"
#include "foundation/elementary/functions.hpp"

namespace tribench {
namespace {

template <F64 (*function)(F64)>
void replace(double* x, std::size_t n) {
  constexpr std::size_t kStep = kWidth<double>;
  std::size_t i = 0;
  for (; i + kStep <= n; i += kStep) store(x + i, function(load<F64>(x + i)));
  if (i < n) store_part(x + i, function(load_part(x + i, n - i)), n - i);
}

constexpr elementary::ColumnTable kColumnTable = {replace<sin>, replace<cos>, replace<tanh>};

}  // namespace
}  // namespace tribench
