// SPDX-License-Identifier: MIT
//
// Some of the rows of a table, spread evenly over it: for what a few of them tell as well as all.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "algorithms/expression/evaluate.hpp"

namespace tribench {

// A copy of at most `most` rows; all where there are no more.
class SpreadRows {
 public:
  SpreadRows(const Inputs& inputs, std::size_t most) : rows_(std::min(inputs.rows, most)) {
    for (const double* column : inputs.columns) {
      std::vector<double>& values = columns_.emplace_back(rows_);
      for (std::size_t k = 0; k < rows_; ++k) values[k] = column[k * inputs.rows / rows_];
    }
    for (const std::vector<double>& column : columns_) pointers_.push_back(column.data());
  }
  Inputs table() const { return {pointers_, rows_}; }

 private:
  std::size_t rows_;
  std::vector<std::vector<double>> columns_;
  std::vector<const double*> pointers_;
};

}  // namespace tribench
