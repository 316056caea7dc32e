// SPDX-License-Identifier: MIT
#include "algorithms/finite_rows.hpp"

#include <cmath>

namespace tribench {

FiniteRows::FiniteRows(const TrainingData& data) : columns(data.columns.size()) {
  for (std::size_t row = 0; row < data.rows(); ++row) {
    bool finite = std::isfinite(data.target[row]);
    for (const double* column : data.columns) finite = finite && std::isfinite(column[row]);
    if (!finite) continue;
    add_row(data.columns, row, data.target[row], data.movement.empty() ? 0 : data.movement[row]);
  }
  point_at_columns();
}

FiniteRows::FiniteRows(const FiniteRows& all, const std::function<bool(std::size_t)>& is_taken)
    : columns(all.columns.size()) {
  for (std::size_t row = 0; row < all.rows(); ++row) {
    if (is_taken(row)) add_row(all.pointers_, row, all.target[row], all.movement[row]);
  }
  point_at_columns();
}

void FiniteRows::add_row(std::span<const double* const> from, std::size_t row, double value,
                         int group) {
  for (std::size_t j = 0; j < columns.size(); ++j) columns[j].push_back(from[j][row]);
  target.push_back(value);
  movement.push_back(group);
}

void FiniteRows::point_at_columns() {
  for (const auto& column : columns) pointers_.push_back(column.data());
}

}  // namespace tribench
