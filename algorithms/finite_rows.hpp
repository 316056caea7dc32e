// SPDX-License-Identifier: MIT
//
// The rows of a method's data that can be used: those whose target and inputs are all finite.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

// A copy of the usable rows, column by column.
struct FiniteRows {
  std::vector<std::vector<double>> columns;
  std::vector<double> target;
  std::vector<int> movement;

  explicit FiniteRows(const TrainingData& data);

  std::size_t rows() const { return target.size(); }
  std::span<const double* const> pointers() const { return pointers_; }
  Inputs table() const { return {pointers_, rows()}; }

  FiniteRows(const FiniteRows&) = delete;
  FiniteRows& operator=(const FiniteRows&) = delete;

 private:
  std::vector<const double*> pointers_;
};

}  // namespace tribench
