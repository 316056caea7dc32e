// SPDX-License-Identifier: MIT
#include "algorithms/inference/evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::loop {

// Of the blocks' columns, each over the root of its block's size: (I + gram)^-1 and what follows.
struct EvidenceTable::Solved {
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd scale;  // of each column
  Eigen::VectorXd mean;
  double squares = 0;  // left of the target, the prior's share included
};

EvidenceTable::EvidenceTable(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                             const Eigen::VectorXd& target) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(base);
  const Eigen::Index rank = qr.rank();
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(base.rows(), rank);
  const Eigen::MatrixXd rest = columns - q * (q.transpose() * columns);
  const Eigen::VectorXd y = target - q * (q.transpose() * target);
  gram_.setZero(columns.cols(), columns.cols());
  gram_.selfadjointView<Eigen::Lower>().rankUpdate(rest.transpose());
  gram_.triangularView<Eigen::StrictlyUpper>() = gram_.transpose();
  cross_ = rest.transpose() * y;
  left_ = gram_.diagonal();
  squares_ = y.squaredNorm();
  dof_ = std::max(1.0, static_cast<double>(target.size() - rank));
}

EvidenceTable::Solved EvidenceTable::solve(std::span<const ColumnBlock* const> blocks) const {
  Eigen::Index count = 0;
  for (const ColumnBlock* block : blocks) count += static_cast<Eigen::Index>(block->size());
  Eigen::MatrixXd gram(count, count);
  Eigen::VectorXd cross(count);
  Solved solved;
  solved.scale.resize(count);
  std::vector<Eigen::Index> columns;
  for (const ColumnBlock* block : blocks) {
    for (const Eigen::Index column : *block) {
      solved.scale[static_cast<Eigen::Index>(columns.size())] =
          1 / std::sqrt(static_cast<double>(block->size()));
      columns.push_back(column);
    }
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      gram(i, j) =
          solved.scale[i] * solved.scale[j] *
          gram_(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
    }
    gram(j, j) += 1;
    cross[j] = solved.scale[j] * cross_[columns[static_cast<std::size_t>(j)]];
  }
  solved.factor.compute(gram);
  solved.mean = solved.factor.solve(cross);
  // Rounding must not make a perfect fit better than perfect.
  solved.squares = std::max(squares_ - cross.dot(solved.mean), 1e-12 * squares_);
  return solved;
}

double EvidenceTable::log_factor(std::span<const ColumnBlock* const> blocks) const {
  if (blocks.empty() || squares_ <= 0) return 0;
  const Solved solved = solve(blocks);
  const Eigen::Index count = solved.mean.size();
  double nats = -0.5 * dof_ * elementary::log(solved.squares / squares_);
  const Eigen::MatrixXd lower = solved.factor.matrixL();
  for (Eigen::Index i = 0; i < count; ++i) nats -= elementary::log(lower(i, i));
  const Eigen::MatrixXd inverse =
      lower.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(count, count));
  const double precision = dof_ / solved.squares;
  Eigen::Index first = 0;
  for (const ColumnBlock* block : blocks) {
    const auto size = static_cast<Eigen::Index>(block->size());
    // The diagonal of the inverse is the squared length of the columns of L^-1.
    const double spread = inverse.middleCols(first, size).squaredNorm();
    const double length = solved.mean.segment(first, size).squaredNorm() * precision;
    nats += elementary::log((length + spread) / static_cast<double>(size));
    first += size;
  }
  return nats;
}

EvidenceTable::Posterior EvidenceTable::posterior(
    std::span<const ColumnBlock* const> blocks) const {
  Posterior out;
  if (blocks.empty()) {
    out.variance = squares_ / dof_;
    return out;
  }
  const Solved solved = solve(blocks);
  const Eigen::Index count = solved.mean.size();
  out.mean = solved.scale.cwiseProduct(solved.mean);
  out.covariance = solved.scale.asDiagonal() *
                   solved.factor.solve(Eigen::MatrixXd::Identity(count, count)) *
                   solved.scale.asDiagonal();
  out.variance = solved.squares / dof_;
  return out;
}

}  // namespace tribench::loop
