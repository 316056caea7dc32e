// SPDX-License-Identifier: MIT
#include "algorithms/udsr/smoother.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "foundation/order_statistics.hpp"

namespace tribench::udsr {
namespace {

std::vector<std::size_t> drawn_rows(std::size_t rows, RandomStream& random) {
  std::vector<std::size_t> order(rows);
  std::iota(order.begin(), order.end(), 0);
  if (rows > Smoother::kMaxRows) {
    random.shuffle(std::span(order));
    order.resize(Smoother::kMaxRows);
    std::ranges::sort(order);
  }
  return order;
}

}  // namespace

Smoother::Smoother(const Inputs& inputs, std::span<const double> target, RandomStream random) {
  const std::vector<std::size_t> rows = drawn_rows(inputs.rows, random);
  const auto n = static_cast<Eigen::Index>(rows.size());
  const auto d = static_cast<Eigen::Index>(inputs.columns.size());
  raw_.resize(n, d);
  target_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t row = rows[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < d; ++j) {
      raw_(i, j) = inputs.columns[static_cast<std::size_t>(j)][row];
    }
    target_[i] = target[row];
  }
  scale_.emplace(raw_);
  points_ = scale_->rows(raw_);
  mean_ = target_.mean();

  double best_length = 1;
  double best_noise = 1e-3;
  held_out_error_ = std::numeric_limits<double>::infinity();
  for (const double length : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    for (const double noise : {1e-8, 1e-5, 1e-3, 1e-2, 1e-1}) {
      const double before = held_out_error_;
      train(length, noise);
      if (held_out_error_ < before) {
        best_length = length;
        best_noise = noise;
      } else {
        held_out_error_ = before;
      }
    }
  }
  train(best_length, best_noise);
}

void Smoother::train(double length, double noise) {
  const Eigen::VectorXd centred = target_.array() - mean_;
  held_out_error_ = process_.train(points_, centred, length, noise)
                        ? upper_median(process_.leave_one_out_errors())
                        : std::numeric_limits<double>::infinity();
}

double Smoother::predict(const Eigen::VectorXd& point) const {
  return mean_ + process_.mean_at(scale_->point(point));
}

}  // namespace tribench::udsr
