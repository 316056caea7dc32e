// SPDX-License-Identifier: MIT
//
// The vector functions for one number, compiled with and without the processor's fused
// multiply-add: two tables of the same bits. Included by scalar_<level>.cpp, which are compiled for
// other instruction sets: no inline functions with external linkage here.
#pragma once

namespace tribench::elementary {

struct ScalarTable {
  double (*exp)(double);
  double (*log)(double);
  double (*sin)(double);
  double (*cos)(double);
  double (*tanh)(double);
  double (*atan)(double);
  double (*pow)(double, double);
};

extern const ScalarTable kScalarBaseline;
#if defined(__x86_64__)
extern const ScalarTable kScalarFma;
#endif

}  // namespace tribench::elementary
