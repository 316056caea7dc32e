// SPDX-License-Identifier: MIT
//
// Columns of numbers that a method's squares and products would carry out of the range of doubles
// (constants of nature, counts of atoms), brought near 1 by powers of two; what the method finds is
// written in the data's own numbers again. A power of two changes no digit: values, and a formula's
// values, are the same bits as long as nothing overflows.
//
// States live in physical units: data that are scaled have no motion for methods to see.
//
// Not for data within 1e-30 .. 1e30: they are handed on as they are, so that nothing changes there.
#pragma once

#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

class ScaledData {
 public:
  // Keeps what `data` looks at by reference; copies only columns that are scaled. A column of zeros
  // or without a finite value is left.
  explicit ScaledData(const TrainingData& data);

  TrainingData data() const {
    TrainingData data{inputs_, columns_, target_, movement_};
    if (is_scaled_) return data;
    data.motion = motion_;
    data.motion_row = motion_row_;
    return data;
  }
  bool is_scaled() const { return is_scaled_; }

  // A formula over data() as one over the data given: each scaled input times its factor, the whole
  // divided by the target's. Not simplified.
  Expression unscaled(const Expression& formula) const;

 private:
  std::vector<Input> inputs_;
  std::vector<const double*> columns_;
  std::vector<std::vector<double>> copies_;
  std::span<const double> target_;
  std::vector<double> target_copy_;
  std::span<const int> movement_;
  MotionRows motion_;
  std::span<const std::size_t> motion_row_;
  std::vector<int> exponents_;  // of an input: it was divided by two to this power
  int target_exponent_ = 0;
  bool is_scaled_ = false;
};

}  // namespace tribench
