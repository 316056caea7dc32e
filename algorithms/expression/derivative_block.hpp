// SPDX-License-Identifier: MIT
//
// The values and adjoints of every place of a tape in one block of rows that stays in cache: the
// way forward, and the columns that the way back (backward_pass.hpp) writes to. Keeps its
// workspace. Internal to the room.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithms/expression/derivative_plan.hpp"
#include "algorithms/expression/evaluate.hpp"

namespace tribench {

// A column of derivatives: scale * data[i], or scale alone where data is null.
struct Adjoint {
  const double* data = nullptr;
  double scale = 0;
};

class DerivativeBlock {
 public:
  // What the columns behind the slots are for; on the way back all but the residual are free.
  enum Spare : std::size_t { kOnes, kResidual, kWeighted, kTemporary, kSpareSlots };

  // Lays out the workspace for the plan and blocks of at most `rows`; the number of rows a block
  // has.
  std::size_t begin(const DerivativePlan& plan, std::size_t rows);

  // The values of all columns at rows row .. row + n - 1.
  void forward(const DerivativePlan& plan, const Inputs& inputs, std::size_t row, std::size_t n);

  double* slot(std::size_t which) { return begin_ + which * stride_; }
  double* spare(Spare which) { return slot(slot_count_ + which); }
  const double* values(std::size_t place) const { return columns_[place]; }
  // The same of a scalar too: `spare_column` filled with it.
  const double* column_of(const DerivativePlan& plan, std::size_t place, double* spare_column,
                          std::size_t n) const;
  Adjoint& adjoint(std::size_t place) { return adjoints_[place]; }

 private:
  void forward_unary(const DerivativePlan::Step& step, double* out, std::size_t n) const;
  void forward_binary(const DerivativePlan& plan, const DerivativePlan::Step& step, double* out,
                      std::size_t n) const;
  void forward_power(const DerivativePlan& plan, const DerivativePlan::Step& step, double* out,
                     std::size_t n);

  std::vector<const double*> columns_;  // per place: the values of a column
  std::vector<Adjoint> adjoints_;       // per place
  std::vector<double> memory_;
  double* begin_ = nullptr;
  std::size_t slot_count_ = 0;
  std::size_t stride_ = 0;
};

}  // namespace tribench
