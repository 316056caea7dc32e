// SPDX-License-Identifier: MIT
#include "algorithms/inference/cross_validation.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"

namespace tribench::loop {
namespace {

// Keeps a fold that lacks a column's excitation solvable; relative to unit diagonals.
constexpr double kRidge = 1e-9;
constexpr double kRounding = 1e-12;
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// Gram matrices of [x y], one a fold.
std::vector<Eigen::MatrixXd> fold_grams(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                        const Clusters& clusters) {
  const Eigen::Index p = x.cols();
  std::vector<Eigen::MatrixXd> grams(static_cast<std::size_t>(clusters.folds),
                                     Eigen::MatrixXd::Zero(p + 1, p + 1));
  for (std::size_t c = 0; c < clusters.stretches.size(); ++c) {
    const auto begin = static_cast<Eigen::Index>(clusters.stretches[c].begin);
    const auto size = static_cast<Eigen::Index>(clusters.stretches[c].size());
    Eigen::MatrixXd& gram = grams[static_cast<std::size_t>(clusters.fold_of[c])];
    const auto rows = x.middleRows(begin, size);
    const auto target = y.segment(begin, size);
    gram.topLeftCorner(p, p) += gram_of(rows);
    gram.col(p).head(p) += cross_products(rows, target);
    gram(p, p) += target.squaredNorm();
  }
  return grams;
}

// `total` has the gram's diagonal over all folds: what the other folds have of a column that only
// the one left out excites is rounding. Nothing can be predicted with it (NaN), unless it is
// penalised: then it has no weight.
Eigen::VectorXd solve_scaled(const Eigen::MatrixXd& gram, const Eigen::VectorXd& total,
                             Eigen::Index penalised = 0, double ridge = 0) {
  const Eigen::Index p = total.size();
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

Eigen::VectorXd held_out_losses(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                const Clusters& clusters, const Noise& noise,
                                Eigen::Index penalised, double ridge) {
  const Eigen::Index p = x.cols();
  const std::vector<Eigen::MatrixXd> grams = fold_grams(x, y, clusters);
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(p + 1, p + 1);
  for (const Eigen::MatrixXd& gram : grams) total += gram;
  std::vector<Eigen::VectorXd> solutions;
  solutions.reserve(grams.size());
  for (const Eigen::MatrixXd& gram : grams) {
    solutions.push_back(solve_scaled(total - gram, total.diagonal().head(p), penalised, ridge));
  }
  const double unit = noise.unit();
  Eigen::VectorXd losses(static_cast<Eigen::Index>(clusters.stretches.size()));
  for (std::size_t c = 0; c < clusters.stretches.size(); ++c) {
    const auto begin = static_cast<Eigen::Index>(clusters.stretches[c].begin);
    const auto size = static_cast<Eigen::Index>(clusters.stretches[c].size());
    const Eigen::VectorXd& solution = solutions[static_cast<std::size_t>(clusters.fold_of[c])];
    losses[static_cast<Eigen::Index>(c)] =
        (y.segment(begin, size) - x.middleRows(begin, size) * solution).squaredNorm() / unit;
  }
  return losses;
}

Gain paired_gain(const Eigen::VectorXd& losses_before, const Eigen::VectorXd& losses_after) {
  const Eigen::VectorXd difference = losses_before - losses_after;
  const auto count = static_cast<double>(difference.size());
  Gain gain;
  gain.nats = difference.sum();
  const double mean = gain.nats / count;
  const double squares = (difference.array() - mean).square().sum();
  gain.error = count > 1 ? std::sqrt(squares / (count - 1) * count) : 0;
  return gain;
}

}  // namespace tribench::loop
