// SPDX-License-Identifier: MIT
#include "algorithms/inference/cross_validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"

namespace tribench::loop {
namespace {

// Keeps a fold that lacks a column's excitation solvable; relative to unit diagonals.
constexpr double kRidge = 1e-9;
constexpr double kRounding = 1e-12;
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// A stretch's rows of a matrix or a vector.
template <typename Matrix>
auto rows_of(const RowRange& stretch, const Matrix& matrix) {
  return matrix.middleRows(static_cast<Eigen::Index>(stretch.begin),
                           static_cast<Eigen::Index>(stretch.size()));
}

std::vector<Eigen::MatrixXd> sums_by_fold(const StretchGrams& grams, const Clusters& clusters) {
  std::vector<Eigen::MatrixXd> sums(static_cast<std::size_t>(clusters.folds),
                                    Eigen::MatrixXd::Zero(grams[0].rows(), grams[0].cols()));
  for (std::size_t c = 0; c < grams.size(); ++c) {
    sums[static_cast<std::size_t>(clusters.fold_of[c])] += grams[c];
  }
  return sums;
}

// |y - x b|^2, from the Gram matrix of [x y].
double squares_left(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b) {
  const Eigen::Index p = b.size();
  const double squares =
      gram(p, p) - 2 * b.dot(gram.col(p).head(p)) + b.dot(gram.topLeftCorner(p, p) * b);
  return squares < 0 ? 0 : squares;  // by rounding; NaN stays
}

// `total` has the gram's diagonal over all folds: what the other folds have of a column that only
// the one left out excites is rounding. Nothing can be predicted with it (NaN), unless it is
// penalised: then it has no weight.
Eigen::VectorXd solve_scaled(const Eigen::MatrixXd& gram, const Eigen::VectorXd& total,
                             Eigen::Index penalised = 0, double ridge = 0) {
  const Eigen::Index p = total.size();
  if (p == 0) return total;
  Eigen::VectorXd scale(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    const bool excited = gram(j, j) > kRounding * total[j];
    const bool may_be_absent = total[j] == 0 || j >= p - penalised;
    scale[j] = excited ? 1 / std::sqrt(gram(j, j)) : may_be_absent ? 0 : kNotKnown;
  }
  Eigen::MatrixXd normal = scale.asDiagonal() * gram.topLeftCorner(p, p) * scale.asDiagonal();
  normal.diagonal().array() += kRidge;
  normal.diagonal().tail(penalised).array() += ridge;
  const Eigen::VectorXd right = scale.cwiseProduct(gram.col(p).head(p));
  return scale.cwiseProduct(solve_symmetric(normal, right));
}

}  // namespace

StretchGrams stretch_grams(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                           const Clusters& clusters) {
  StretchGrams of_target;
  for (const RowRange& stretch : clusters.stretches) {
    of_target.push_back(Eigen::MatrixXd::Constant(1, 1, rows_of(stretch, y).squaredNorm()));
  }
  return with_columns(of_target, Eigen::MatrixXd(x.rows(), 0), y, x, clusters);
}

StretchGrams with_columns(const StretchGrams& grams, const Eigen::MatrixXd& x,
                          const Eigen::VectorXd& y, const Eigen::MatrixXd& more,
                          const Clusters& clusters) {
  const Eigen::Index p = x.cols();
  const Eigen::Index q = more.cols();
  if (q == 0) return grams;
  StretchGrams wider;
  wider.reserve(grams.size());
  for (std::size_t c = 0; c < clusters.stretches.size(); ++c) {
    const auto rows = rows_of(clusters.stretches[c], more);
    const auto target = rows_of(clusters.stretches[c], y);
    Eigen::MatrixXd gram(p + q + 1, p + q + 1);
    gram.topLeftCorner(p, p) = grams[c].topLeftCorner(p, p);
    if (p > 0) {
      gram.block(p, 0, q, p) = cross_products(rows, rows_of(clusters.stretches[c], x));
      gram.block(0, p, p, q) = gram.block(p, 0, q, p).transpose();
    }
    gram.block(p, p, q, q) = gram_of(rows);
    gram.col(p + q).head(p) = grams[c].col(p).head(p);
    gram.col(p + q).segment(p, q) = cross_products(rows, target);
    gram.row(p + q).head(p + q) = gram.col(p + q).head(p + q);
    gram(p + q, p + q) = grams[c](p, p);
    wider.push_back(std::move(gram));
  }
  return wider;
}

Eigen::VectorXd coefficients_of(const StretchGrams& grams) {
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(grams[0].rows(), grams[0].cols());
  for (const Eigen::MatrixXd& gram : grams) total += gram;
  return solve_scaled(total, total.diagonal().head(total.cols() - 1));
}

Eigen::VectorXd held_out_losses(const StretchGrams& grams, const Clusters& clusters,
                                const Noise& noise, Eigen::Index penalised, double ridge) {
  const Eigen::Index p = grams[0].cols() - 1;
  const std::vector<Eigen::MatrixXd> folds = sums_by_fold(grams, clusters);
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(p + 1, p + 1);
  for (const Eigen::MatrixXd& gram : folds) total += gram;
  std::vector<Eigen::VectorXd> solutions;
  solutions.reserve(folds.size());
  for (const Eigen::MatrixXd& gram : folds) {
    solutions.push_back(solve_scaled(total - gram, total.diagonal().head(p), penalised, ridge));
  }
  Eigen::VectorXd losses(static_cast<Eigen::Index>(grams.size()));
  for (std::size_t c = 0; c < grams.size(); ++c) {
    losses[static_cast<Eigen::Index>(c)] =
        squares_left(grams[c], solutions[static_cast<std::size_t>(clusters.fold_of[c])]) /
        noise.unit();
  }
  return losses;
}

Eigen::VectorXd held_out_losses(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                const Clusters& clusters, const Noise& noise,
                                Eigen::Index penalised, double ridge) {
  return held_out_losses(stretch_grams(x, y, clusters), clusters, noise, penalised, ridge);
}

namespace {

// The standard error of the sum of what the clusters gain.
double error_of_sum(const Eigen::VectorXd& gains) {
  const auto count = static_cast<double>(gains.size());
  const double squares = (gains.array() - gains.mean()).square().sum();
  return count > 1 ? std::sqrt(squares / (count - 1) * count) : 0;
}

}  // namespace

Gain paired_gain(const Eigen::VectorXd& losses_before, const Eigen::VectorXd& losses_after) {
  const Eigen::VectorXd gains = losses_before - losses_after;
  const Eigen::VectorXd bounded = gains.cwiseMax(-kMostOfOneCluster).cwiseMin(kMostOfOneCluster);
  // Where every cluster gains as much as counts there is no error.
  const double error = std::max(error_of_sum(bounded), std::numeric_limits<double>::min());
  return {gains.sum(), error_of_sum(gains), gains.size() > 1 ? bounded.sum() / error : 0};
}

}  // namespace tribench::loop
