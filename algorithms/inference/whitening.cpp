// SPDX-License-Identifier: MIT
#include "algorithms/inference/whitening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kSteady = 1e-15;

std::size_t longest_movement(const Clusters& clusters) {
  std::size_t longest = 1;
  for (const RowRange& m : clusters.movements) longest = std::max(longest, m.size());
  return longest;
}

}  // namespace

RowFilter::RowFilter(const Noise& noise, std::size_t longest) {
  if (!noise.whitened || !(noise.within_sd > 0)) {
    returned_ = {0};
    scale_ = {1};
    offset_ = {1};
    return;
  }
  const double variance = noise.within_sd * noise.within_sd;
  const double steady = noise.row_variance() / variance;
  const double white = 1 - noise.slow_share;
  const double rho = noise.slow_rho;
  carried_ = rho;
  double slow = noise.slow_share;  // variance of the slow part, foretold
  double returned = 0;
  double missed = 1;  // of rows that are all 1
  for (std::size_t k = 0; k < longest; ++k) {
    const double total = slow + white;
    if (k > 0) missed = 1 - rho + returned * missed;
    returned_.push_back(returned);
    scale_.push_back(std::sqrt(steady / total));
    offset_.push_back(scale_.back() * missed);
    const bool settled = k > 0 && std::abs(total - steady) <= kSteady * steady &&
                         std::abs(offset_[k] - offset_[k - 1]) <= kSteady;
    if (settled) break;
    const double unknown = white / total;  // share of the slow part that a row does not tell
    returned = rho * unknown;
    slow = rho * rho * slow * unknown + noise.slow_share * (1 - rho * rho);
  }
}

Whitening::Whitening(const Clusters& clusters, const Noise& noise)
    : clusters_(clusters), noise_(noise), filter_(noise, longest_movement(clusters)) {
  direction_.resize(static_cast<Eigen::Index>(longest_movement(clusters)));
  for (Eigen::Index k = 0; k < direction_.size(); ++k) {
    direction_[k] = filter_.offset(static_cast<std::size_t>(k));
  }
  squares_until_ = {0};
  for (std::size_t k = 0; k < filter_.steady_from(); ++k) {
    squares_until_.push_back(squares_until_.back() + filter_.offset(k) * filter_.offset(k));
  }
}

OffsetShrinkage Whitening::offset_of(std::size_t movement) const {
  const std::size_t rows = clusters_.movements[movement].size();
  OffsetShrinkage u{};
  const std::size_t changing = std::min(rows, filter_.steady_from());
  u.length = squares_until_[changing];
  const double last = filter_.offset(filter_.steady_from());
  u.length += static_cast<double>(rows - changing) * last * last;
  u.noise = noise_.row_variance() * std::min(noise_.row_inflation(), static_cast<double>(rows));
  const double between = noise_.between_sd * clusters_.weight_of(movement);
  u.offset = between * between * u.length;
  u.kept = std::sqrt(noise_.row_variance() / (u.noise + u.offset));
  return u;
}

template <int kColumns>
void Whitening::filter_columns(double* first, Eigen::Index stride, std::size_t rows) const {
  const double carried = filter_.carried();
  std::array<double*, kColumns> column;
  std::array<double, kColumns> before;
  std::array<double, kColumns> missed;
  for (int j = 0; j < kColumns; ++j) {
    column[j] = first + j * stride;
    before[j] = missed[j] = column[j][0];
    column[j][0] *= filter_.scale(0);
  }
  const auto next = [&](std::size_t k, double returned, double scale) {
    for (int j = 0; j < kColumns; ++j) {
      const double now = column[j][k];
      missed[j] = now - carried * before[j] + returned * missed[j];
      before[j] = now;
      column[j][k] = scale * missed[j];
    }
  };
  const std::size_t changing = std::clamp<std::size_t>(filter_.steady_from(), 1, rows);
  for (std::size_t k = 1; k < changing; ++k) next(k, filter_.returned(k), filter_.scale(k));
  const double returned = filter_.returned(filter_.steady_from());
  const double scale = filter_.scale(filter_.steady_from());
  for (std::size_t k = changing; k < rows; ++k) next(k, returned, scale);
}

void Whitening::filter_rows(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (filter_.carried() == 0) return;
  // Each row waits for the one before; columns do not wait for each other.
  constexpr Eigen::Index kAtOnce = 4;
  const auto count = static_cast<std::size_t>(rows.rows());
  Eigen::Index j = 0;
  for (; j + kAtOnce <= rows.cols(); j += kAtOnce) {
    filter_columns<kAtOnce>(rows.col(j).data(), rows.outerStride(), count);
  }
  for (; j < rows.cols(); ++j) filter_columns<1>(rows.col(j).data(), rows.outerStride(), count);
}

// Of filtered rows of a movement, its weight too.
void Whitening::shrink_offset(std::size_t movement, Eigen::Ref<Eigen::MatrixXd> rows) const {
  const OffsetShrinkage u = offset_of(movement);
  if (u.kept != 1) {  // of noise without offsets nothing is taken
    const auto direction = direction_.head(rows.rows());
    for (Eigen::Index j = 0; j < rows.cols(); ++j) {
      const double shift = (1 - u.kept) * direction.dot(rows.col(j)) / u.length;
      rows.col(j) -= shift * direction;
    }
  }
  const double weight = clusters_.weight_of(movement);
  if (weight != 1) rows *= weight;
}

Eigen::MatrixXd Whitening::of(Eigen::MatrixXd columns) const {
  if (columns.cols() == 0) return columns;
  for (std::size_t m = 0; m < clusters_.movements.size(); ++m) {
    const RowRange& range = clusters_.movements[m];
    auto block = columns.middleRows(static_cast<Eigen::Index>(range.begin),
                                    static_cast<Eigen::Index>(range.size()));
    filter_rows(block);
    shrink_offset(m, block);
  }
  return columns;
}

Eigen::MatrixXd Whitening::filtered(Eigen::MatrixXd columns) const {
  for (const RowRange& range : clusters_.movements) {
    filter_rows(columns.middleRows(static_cast<Eigen::Index>(range.begin),
                                   static_cast<Eigen::Index>(range.size())));
  }
  return columns;
}

void Whitening::filter_backwards(Eigen::Ref<Eigen::VectorXd> rows) const {
  if (filter_.carried() == 0) return;
  double after = 0;  // what the next row's filter was told
  for (Eigen::Index k = rows.size(); k-- > 0;) {
    const auto row = static_cast<std::size_t>(k);
    const double told = filter_.scale(row) * rows[k] + filter_.returned(row + 1) * after;
    rows[k] = told - filter_.carried() * after;
    after = told;
  }
}

// The shrinkage is its own adjoint.
Eigen::VectorXd Whitening::adjoint(Eigen::VectorXd rows) const {
  for (std::size_t m = 0; m < clusters_.movements.size(); ++m) {
    const RowRange& range = clusters_.movements[m];
    auto block = rows.segment(static_cast<Eigen::Index>(range.begin),
                              static_cast<Eigen::Index>(range.size()));
    shrink_offset(m, block);
    filter_backwards(block);
  }
  return rows;
}

Eigen::VectorXd Whitening::offset_nats() const {
  std::vector<double> stretches(clusters_.movements.size(), 0.0);
  for (const std::size_t m : clusters_.movement_of) ++stretches[m];
  Eigen::VectorXd nats(static_cast<Eigen::Index>(clusters_.stretches.size()));
  for (std::size_t c = 0; c < clusters_.stretches.size(); ++c) {
    const std::size_t m = clusters_.movement_of[c];
    const OffsetShrinkage u = offset_of(m);
    nats[static_cast<Eigen::Index>(c)] = 0.5 * elementary::log1p(u.offset / u.noise) / stretches[m];
  }
  return nats;
}

Eigen::MatrixXd whitened(Eigen::MatrixXd columns, const Clusters& clusters, const Noise& noise) {
  return Whitening(clusters, noise).of(std::move(columns));
}

Eigen::VectorXd offset_nats(const Clusters& clusters, const Noise& noise) {
  return Whitening(clusters, noise).offset_nats();
}

}  // namespace tribench::loop
