// SPDX-License-Identifier: MIT
#include "algorithms/pysr/rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tribench::pysr {

Rows::Rows(std::vector<std::vector<double>> columns_of_inputs, std::vector<double> target_values)
    : columns(std::move(columns_of_inputs)), target(std::move(target_values)) {
  for (const std::vector<double>& column : columns) pointers.push_back(column.data());
}

Rows complete_rows(const TrainingData& data) {
  std::vector<std::vector<double>> columns(data.columns.size());
  std::vector<double> target;
  for (std::size_t r = 0; r < data.rows(); ++r) {
    const bool complete =
        std::isfinite(data.target[r]) &&
        std::ranges::all_of(data.columns, [r](const double* c) { return std::isfinite(c[r]); });
    if (!complete) continue;
    for (std::size_t j = 0; j < columns.size(); ++j) columns[j].push_back(data.columns[j][r]);
    target.push_back(data.target[r]);
  }
  return {std::move(columns), std::move(target)};
}

Rows rows_at(const Rows& rows, std::span<const std::size_t> places) {
  std::vector<std::vector<double>> columns(rows.columns.size());
  std::vector<double> target;
  target.reserve(places.size());
  for (const std::size_t place : places) target.push_back(rows.target[place]);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    columns[j].reserve(places.size());
    for (const std::size_t place : places) columns[j].push_back(rows.columns[j][place]);
  }
  return {std::move(columns), std::move(target)};
}

Rows draw_batch(const Rows& rows, std::size_t count, RandomStream& random) {
  std::vector<std::size_t> places(count);
  for (std::size_t& place : places) place = random.below(rows.size());
  return rows_at(rows, places);
}

Rows draw_sample(const Rows& rows, std::size_t count, RandomStream& random) {
  std::vector<std::size_t> places(rows.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  if (count > 0 && count < rows.size()) {
    random.shuffle(std::span(places));
    places.resize(count);
    std::ranges::sort(places);
  }
  return rows_at(rows, places);
}

}  // namespace tribench::pysr
