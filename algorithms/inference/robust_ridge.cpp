// SPDX-License-Identifier: MIT
#include "algorithms/inference/robust_ridge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"

namespace tribench::loop {
namespace {

constexpr double kRidge = 1e-4;  // of the mean diagonal
constexpr double kHuber = 2;     // standard deviations

void scale_to_unit_length(Eigen::MatrixXd& x) {
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    const double norm = x.col(j).norm();
    x.col(j) = norm > 0 && std::isfinite(norm) ? Eigen::VectorXd(x.col(j) / norm)
                                               : Eigen::VectorXd::Zero(x.rows());
  }
}

}  // namespace

Eigen::VectorXd robust_ridge_residual(Eigen::MatrixXd x, const Eigen::VectorXd& y,
                                      std::span<const Eigen::Index> train) {
  scale_to_unit_length(x);
  const Eigen::MatrixXd rows = x(train, Eigen::all);
  Eigen::MatrixXd normal = gram_of(rows);
  Eigen::VectorXd right = cross_products(rows, y(train));
  const auto residual_of = [&] {
    Eigen::MatrixXd loaded = normal;
    loaded.diagonal().array() += kRidge * normal.trace() / static_cast<double>(normal.rows());
    return Eigen::VectorXd(y - x * solve_symmetric(loaded, right));
  };
  const Eigen::VectorXd residual = residual_of();
  const double sd =
      std::sqrt(residual(train).squaredNorm() / std::max(1.0, static_cast<double>(train.size())));
  std::vector<Eigen::Index> wild;  // few rows have a weight below 1
  for (const Eigen::Index i : train) {
    if (std::abs(residual[i]) > kHuber * sd) wild.push_back(i);
  }
  if (wild.empty()) return residual;
  const Eigen::VectorXd lost = 1 - kHuber * sd / residual(wild).array().abs();
  const Eigen::MatrixXd wild_rows = lost.cwiseSqrt().asDiagonal() * x(wild, Eigen::all);
  normal -= gram_of(wild_rows);
  right -= cross_products(wild_rows, lost.cwiseSqrt().cwiseProduct(y(wild)));
  return residual_of();
}

}  // namespace tribench::loop
