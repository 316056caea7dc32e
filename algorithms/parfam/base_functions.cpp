// SPDX-License-Identifier: MIT
#include "algorithms/parfam/base_functions.hpp"

#include <cmath>

#include "algorithms/expression/column_kernels.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/sign.hpp"

namespace tribench::parfam {
namespace {

const double kExpCeiling = elementary::exp(10.0);
double log_floor(Convention convention) {
  return convention == Convention::published ? kLogFloor : 0;
}

[[noreturn]] void unknown() { throw Error(ErrorKind::failed, "ParFam has no such base function"); }

}  // namespace

void apply_function(Op function, Convention convention, const double* u, double* values,
                    std::size_t rows) {
  switch (function) {
    case Op::sqrt:
      columns::abs(u, values, rows);
      return columns::sqrt(values, values, rows);
    case Op::exp:
      columns::exp(u, values, rows);
      if (convention == Convention::exact) return;
      for (std::size_t r = 0; r < rows; ++r) {
        values[r] = std::fmin(values[r], kExpCeiling + std::abs(u[r]));
      }
      return;
    case Op::log:
      columns::abs(u, values, rows);
      columns::add(values, log_floor(convention), values, rows);
      return columns::log(values, values, rows);
    case Op::sin:
      return columns::sin(u, values, rows);
    case Op::cos:
      return columns::cos(u, values, rows);
    case Op::tanh:
      return columns::tanh(u, values, rows);
    default:
      unknown();
  }
}

void function_slope(Op function, Convention convention, const double* u, const double* values,
                    double* slopes, std::size_t rows) {
  switch (function) {
    case Op::sqrt:
      for (std::size_t r = 0; r < rows; ++r)
        slopes[r] = u[r] == 0 ? 0 : sign(u[r]) / (2 * values[r]);
      return;
    case Op::exp:
      for (std::size_t r = 0; r < rows; ++r) {
        const bool clipped =
            convention == Convention::published && values[r] == kExpCeiling + std::abs(u[r]);
        slopes[r] = clipped ? sign(u[r]) : values[r];
      }
      return;
    case Op::log:
      for (std::size_t r = 0; r < rows; ++r) {
        slopes[r] = u[r] == 0 ? 0 : sign(u[r]) / (std::abs(u[r]) + log_floor(convention));
      }
      return;
    case Op::sin:
      return columns::cos(u, slopes, rows);
    case Op::cos:
      columns::sin(u, slopes, rows);
      return columns::mul(slopes, -1.0, slopes, rows);
    case Op::tanh:
      return columns::one_minus_square(values, slopes, rows);
    default:
      unknown();
  }
}

}  // namespace tribench::parfam
