// SPDX-License-Identifier: MIT
//
// The rows of a method's data that can be used: those whose target and inputs are all finite.
#pragma once

#include <cstddef>
#include <functional>
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
  // Of these those that are taken, by their numbers.
  FiniteRows(const FiniteRows& all, const std::function<bool(std::size_t)>& is_taken);

  std::size_t rows() const { return target.size(); }
  std::span<const double* const> pointers() const { return pointers_; }
  Inputs table() const { return {pointers_, rows()}; }
  // For methods without states.
  TrainingData as_data(std::span<const Input> inputs) const {
    return {inputs, pointers_, target, movement};
  }

  FiniteRows(const FiniteRows&) = delete;
  FiniteRows& operator=(const FiniteRows&) = delete;

 private:
  void add_row(std::span<const double* const> from, std::size_t row, double value, int group);
  void point_at_columns();

  std::vector<const double*> pointers_;
};

}  // namespace tribench
