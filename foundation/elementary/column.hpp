// SPDX-License-Identifier: MIT
//
// The vector functions for a column of numbers, in place, compiled with and without the processor's
// wide registers: two tables of the same bits as scalar.hpp's. Included by column_<level>.cpp,
// which are compiled for other instruction sets: no inline functions with external linkage here.
#pragma once

#include <cstddef>

namespace tribench::elementary {

struct ColumnTable {
  void (*exp)(double* x, std::size_t n);
  void (*sin)(double* x, std::size_t n);
  void (*cos)(double* x, std::size_t n);
  void (*tanh)(double* x, std::size_t n);
  void (*pow)(double* x, std::size_t n, double y);
};

extern const ColumnTable kColumnBaseline;
#if defined(__x86_64__)
extern const ColumnTable kColumnFma;
#endif

}  // namespace tribench::elementary
