// SPDX-License-Identifier: MIT
#include "algorithms/finite_rows.hpp"

#include <cmath>

namespace tribench {

FiniteRows::FiniteRows(const TrainingData& data) : columns(data.columns.size()) {
  for (std::size_t row = 0; row < data.rows(); ++row) {
    bool finite = std::isfinite(data.target[row]);
    for (const double* column : data.columns) finite = finite && std::isfinite(column[row]);
    if (!finite) continue;
    for (std::size_t j = 0; j < columns.size(); ++j) columns[j].push_back(data.columns[j][row]);
    target.push_back(data.target[row]);
    movement.push_back(data.movement.empty() ? 0 : data.movement[row]);
  }
  for (const auto& column : columns) pointers_.push_back(column.data());
}

}  // namespace tribench
