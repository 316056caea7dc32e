// SPDX-License-Identifier: MIT
#include "algorithms/inference/evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kSameDirection = 1e-10;  // of base columns of unit length

// Columns z with z z' the inverse of the base's products, in the directions that the rows have.
Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& products) {
  const Eigen::VectorXd length =
      products.diagonal().cwiseSqrt().unaryExpr([](double x) { return x > 0 ? x : 1.0; });
  const Eigen::MatrixXd unit =
      length.cwiseInverse().asDiagonal() * products * length.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(unit);
  const double least = kSameDirection * parts.eigenvalues().maxCoeff();
  const auto dropped = static_cast<Eigen::Index>(
      std::ranges::count_if(parts.eigenvalues(), [&](double value) { return !(value > least); }));
  const Eigen::Index rank = unit.rows() - dropped;
  return length.cwiseInverse().asDiagonal() * parts.eigenvectors().rightCols(rank) *
         parts.eigenvalues().tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

// Of the columns, those of a block times its size, over the root of how many they are, then those
// of the misfits: (I + gram)^-1 and what follows.
struct EvidenceTable::Solved {
  ColumnBlock columns;
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd scale;  // of each column
  Eigen::VectorXd mean;
  double squares = 0;  // left of the target, the prior's share included
};

void EvidenceSums::add(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                       const Eigen::VectorXd& target) {
  Eigen::MatrixXd all(base.rows(), base.cols() + columns.cols() + 1);
  all << base, columns, target;
  if (products_.size() == 0) products_.setZero(all.cols(), all.cols());
  products_.selfadjointView<Eigen::Lower>().rankUpdate(all.transpose());
  rows_ += base.rows();
  base_ = base.cols();
}

EvidenceTable::EvidenceTable(const EvidenceSums& sums) {
  const Eigen::Index base = sums.base_count();
  const Eigen::Index rest = sums.products().cols() - base;
  const Eigen::MatrixXd& lower = sums.products();
  const Eigen::MatrixXd own = lower.topLeftCorner(base, base).selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd root = inverse_root(own);
  const Eigen::MatrixXd across = lower.bottomLeftCorner(rest, base) * root;
  Eigen::MatrixXd left = lower.bottomRightCorner(rest, rest);
  left.selfadjointView<Eigen::Lower>().rankUpdate(across, -1.0);
  gram_ = left.topLeftCorner(rest - 1, rest - 1).selfadjointView<Eigen::Lower>();
  cross_ = left.row(rest - 1).head(rest - 1);
  squares_ = std::max(left(rest - 1, rest - 1), 0.0);
  dof_ = std::max(1.0, static_cast<double>(sums.rows() - root.cols()));
}

EvidenceTable::Solved EvidenceTable::solve(std::span<const EffectBlock* const> blocks) const {
  Solved solved;
  ColumnBlock& columns = solved.columns;
  std::vector<double> scale;
  for (const EffectBlock* block : blocks) {
    columns.insert(columns.end(), block->columns.begin(), block->columns.end());
    const auto count = static_cast<double>(block->columns.size());
    scale.resize(columns.size(), block->size / std::sqrt(count));
  }
  for (const EffectBlock* block : blocks) {
    columns.insert(columns.end(), block->misfit.begin(), block->misfit.end());
    scale.resize(columns.size(), block->size);
  }
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd gram(count, count);
  Eigen::VectorXd cross(count);
  solved.scale = Eigen::Map<const Eigen::VectorXd>(scale.data(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Eigen::Index column = columns[static_cast<std::size_t>(j)];
    for (Eigen::Index i = j; i < count; ++i) {
      gram(i, j) =
          solved.scale[i] * solved.scale[j] * gram_(columns[static_cast<std::size_t>(i)], column);
    }
    gram(j, j) += 1;
    cross[j] = solved.scale[j] * cross_[column];
  }
  solved.factor.compute(gram);
  solved.mean = solved.factor.solve(cross);
  // Rounding must not make a perfect fit better than perfect.
  solved.squares = std::max(squares_ - cross.dot(solved.mean), 1e-12 * squares_);
  return solved;
}

double EvidenceTable::log_factor(std::span<const EffectBlock* const> blocks) const {
  if (blocks.empty() || squares_ <= 0) return 0;
  const Solved solved = solve(blocks);
  double nats = -0.5 * dof_ * elementary::log(solved.squares / squares_);
  const auto& lower = solved.factor.matrixLLT();
  double determinant = 1;
  for (Eigen::Index i = 0; i < lower.rows(); ++i) {
    determinant *= lower(i, i);
    if (determinant > 1e100 || i + 1 == lower.rows()) {
      nats -= elementary::log(determinant);
      determinant = 1;
    }
  }
  Eigen::Index own = 0;
  for (const EffectBlock* block : blocks) own += static_cast<Eigen::Index>(block->columns.size());
  // The diagonal of the inverse is the squared length of the columns of L^-1.
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(lower.rows(), own);
  solved.factor.matrixL().solveInPlace(inverse);
  const double precision = dof_ / solved.squares;
  Eigen::Index first = 0;
  for (const EffectBlock* block : blocks) {
    const auto size = static_cast<Eigen::Index>(block->columns.size());
    const double spread = inverse.middleCols(first, size).squaredNorm();
    const double length = solved.mean.segment(first, size).squaredNorm() * precision;
    nats += elementary::log((length + spread) / static_cast<double>(size));
    first += size;
  }
  return nats;
}

EvidenceTable::Posterior EvidenceTable::posterior(
    std::span<const EffectBlock* const> blocks) const {
  Posterior out;
  if (blocks.empty()) {
    out.variance = squares_ / dof_;
    return out;
  }
  const Solved solved = solve(blocks);
  out.mean = solved.scale.cwiseProduct(solved.mean);
  out.variance = solved.squares / dof_;
  return out;
}

Eigen::VectorXd EvidenceTable::left_of_products(std::span<const EffectBlock* const> blocks) const {
  if (blocks.empty()) return cross_;
  const Solved solved = solve(blocks);
  Eigen::VectorXd left = cross_;
  for (std::size_t k = 0; k < solved.columns.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    left -= solved.scale[i] * solved.mean[i] * gram_.col(solved.columns[k]);
  }
  return left;
}

}  // namespace tribench::loop
