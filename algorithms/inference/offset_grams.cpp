// SPDX-License-Identifier: MIT
#include "algorithms/inference/offset_grams.hpp"

#include <cstddef>

#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {
namespace {

using Eigen::Index;

auto rows_of(const RowRange& range, const Eigen::MatrixXd& columns) {
  return columns.middleRows(static_cast<Index>(range.begin), static_cast<Index>(range.size()));
}

// The offset's direction in filtered rows, one movement below the other.
Eigen::VectorXd offset_directions(const Clusters& clusters, const RowFilter& filter) {
  Eigen::VectorXd direction(static_cast<Index>(clusters.rows));
  for (const RowRange& m : clusters.movements) {
    for (std::size_t k = 0; k < m.size(); ++k) {
      direction[static_cast<Index>(m.begin + k)] = filter.offset(k);
    }
  }
  return direction;
}

Eigen::MatrixXd products_along(const Eigen::VectorXd& direction, const Eigen::MatrixXd& columns,
                               const Clusters& clusters) {
  Eigen::MatrixXd out(columns.cols(), static_cast<Index>(clusters.stretches.size()));
  for (Index c = 0; c < out.cols(); ++c) {
    const RowRange& stretch = clusters.stretches[static_cast<std::size_t>(c)];
    out.col(c) = rows_of(stretch, columns).transpose() * rows_of(stretch, direction);
  }
  return out;
}

Eigen::MatrixXd means_of(const Eigen::MatrixXd& columns, const Clusters& clusters) {
  Eigen::MatrixXd out(columns.cols(), static_cast<Index>(clusters.movements.size()));
  for (Index m = 0; m < out.cols(); ++m) {
    out.col(m) = rows_of(clusters.movements[static_cast<std::size_t>(m)], columns).colwise().mean();
  }
  return out;
}

// The last row is the target's.
Eigen::MatrixXd with_rows(const Eigen::MatrixXd& own, const Eigen::MatrixXd& more) {
  Eigen::MatrixXd out(own.rows() + more.rows(), own.cols());
  out << own.topRows(own.rows() - 1), more, own.bottomRows(1);
  return out;
}

}  // namespace

void OffsetGrams::sum_up_movements() {
  const Index columns = along_.rows();
  const std::size_t movements = clusters_->movements.size();
  filtered_of_movement_.assign(movements, Eigen::MatrixXd::Zero(columns, columns));
  along_movement_.setZero(columns, static_cast<Index>(movements));
  for (std::size_t c = 0; c < filtered_.size(); ++c) {
    const std::size_t m = clusters_->movement_of[c];
    filtered_of_movement_[m] += filtered_[c];
    along_movement_.col(static_cast<Index>(m)) += along_.col(static_cast<Index>(c));
  }
}

// With z = f - share (d'f) d in a movement's rows, for every column f of filtered rows.
StretchGrams OffsetGrams::at(double between_sd) const {
  Noise noise = noise_;
  noise.between_sd = between_sd;
  const Whitening whitening(*clusters_, noise);
  StretchGrams out = filtered_;
  for (std::size_t c = 0; c < out.size(); ++c) {
    const std::size_t m = clusters_->movement_of[c];
    const OffsetShrinkage u = whitening.offset_of(m);
    const double share = (1 - u.kept) / u.length;
    const auto at = static_cast<Index>(c);
    const Eigen::VectorXd taken = share * along_movement_.col(static_cast<Index>(m));
    const Eigen::VectorXd beside = along_.col(at) - 0.5 * square_[at] * taken;
    out[c].noalias() -= taken * beside.transpose();
    out[c].noalias() -= beside * taken.transpose();
    out[c] *= clusters_->weight_of(m) * clusters_->weight_of(m);
  }
  return out;
}

Eigen::VectorXd OffsetGrams::coefficients_at(double between_sd) const {
  Noise noise = noise_;
  noise.between_sd = between_sd;
  const Whitening whitening(*clusters_, noise);
  StretchGrams out = filtered_of_movement_;
  for (std::size_t m = 0; m < out.size(); ++m) {
    const OffsetShrinkage u = whitening.offset_of(m);
    const double share = (1 - u.kept) / u.length;
    const auto along = along_movement_.col(static_cast<Index>(m));
    out[m].noalias() -= share * (2 - share * u.length) * along * along.transpose();
    out[m] *= clusters_->weight_of(m) * clusters_->weight_of(m);
  }
  return coefficients_of(out);
}

double OffsetGrams::spread_beside(const Eigen::VectorXd& b) const {
  const Index p = b.size();
  return offset_spread(means_.row(p).transpose() - means_.topRows(p).transpose() * b, *clusters_,
                       noise_);
}

FilteredModel::FilteredModel(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                             const Clusters& clusters, const Noise& noise)
    : own_(clusters, noise) {
  const Whitening whitening(clusters, noise);
  x_ = whitening.filtered(x);
  y_ = whitening.filtered(y);
  const Eigen::VectorXd direction = offset_directions(clusters, whitening.filter());
  Eigen::MatrixXd both(x.rows(), x.cols() + 1);
  both << x_, y_;
  own_.along_ = products_along(direction, both, clusters);
  own_.square_ = products_along(direction, direction, clusters).transpose();
  own_.filtered_ = stretch_grams(x_, y_, clusters);
  both << x, y;
  own_.means_ = means_of(both, clusters);
}

OffsetGrams FilteredModel::beside(const Eigen::MatrixXd& more) const {
  const Clusters& clusters = *own_.clusters_;
  const Whitening whitening(clusters, own_.noise_);
  const Eigen::MatrixXd rows = whitening.filtered(more);
  const Eigen::VectorXd direction = offset_directions(clusters, whitening.filter());
  OffsetGrams out = own_;
  out.filtered_ = with_columns(own_.filtered_, x_, y_, rows, clusters);
  out.along_ = with_rows(own_.along_, products_along(direction, rows, clusters));
  out.means_ = with_rows(own_.means_, means_of(more, clusters));
  out.sum_up_movements();
  return out;
}

}  // namespace tribench::loop
