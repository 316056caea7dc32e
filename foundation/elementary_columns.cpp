// SPDX-License-Identifier: MIT
#include "foundation/elementary_columns.hpp"

#include "foundation/elementary/column.hpp"

namespace tribench::elementary {
namespace {

const ColumnTable& column_table() {
#if defined(__x86_64__)
  static const ColumnTable& chosen = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
                                         ? kColumnFma
                                         : kColumnBaseline;
  return chosen;
#else
  return kColumnBaseline;
#endif
}

}  // namespace

void sin_of_each(std::span<double> x) { column_table().sin(x.data(), x.size()); }
void cos_of_each(std::span<double> x) { column_table().cos(x.data(), x.size()); }
void tanh_of_each(std::span<double> x) { column_table().tanh(x.data(), x.size()); }

}  // namespace tribench::elementary
