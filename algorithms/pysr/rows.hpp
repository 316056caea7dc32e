// SPDX-License-Identifier: MIT
//
// Training rows that a search may use: complete ones, or a sample of them.
#pragma once

#include <span>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench::pysr {

// Owns its columns. Every value is finite.
struct Rows {
  std::vector<std::vector<double>> columns;
  std::vector<double> target;
  std::vector<const double*> pointers;  // to the columns

  Rows() = default;
  Rows(std::vector<std::vector<double>> columns_of_inputs, std::vector<double> target_values);
  Rows(Rows&&) = default;
  Rows& operator=(Rows&&) = default;

  std::size_t size() const { return target.size(); }
  Inputs inputs() const { return {pointers, size()}; }
};

// The rows of which every input and the target are finite, in order.
Rows complete_rows(const TrainingData& data);

// The rows at the given places, which may repeat.
Rows rows_at(const Rows& rows, std::span<const std::size_t> places);

// `count` rows drawn with replacement: a batch.
Rows draw_batch(const Rows& rows, std::size_t count, RandomStream& random);

// `count` different rows, in order; all where count is 0 or not below the size.
Rows draw_sample(const Rows& rows, std::size_t count, RandomStream& random);

}  // namespace tribench::pysr
