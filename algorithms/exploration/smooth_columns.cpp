// SPDX-License-Identifier: MIT
#include "algorithms/exploration/smooth_columns.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kNearest = 1e-3;  // of the farthest: distances below count alike
constexpr double kReach = 6;       // widths: beyond, a radial function is nothing

}  // namespace

SignalAxis::SignalAxis(const Observations& reference, std::string_view signal) : signal_(signal) {
  const Signal* found = reference.find(signal);
  if (found == nullptr || found->values.empty()) return;
  if (signal == "d") farthest_ = *std::ranges::max_element(found->values);
  if (!(farthest_ > 0)) return;
  const Eigen::ArrayXd x = values(reference);
  std::vector<double> sorted(x.begin(), x.end());
  const auto edge = static_cast<std::ptrdiff_t>(sorted.size() / 200);
  std::ranges::nth_element(sorted, sorted.begin() + edge);
  low_ = sorted[static_cast<std::size_t>(edge)];
  std::ranges::nth_element(sorted, sorted.end() - 1 - edge);
  high_ = *(sorted.end() - 1 - edge);
}

Eigen::ArrayXd SignalAxis::values(const Observations& rows) const {
  const std::vector<double>& own = rows.find(signal_)->values;
  Eigen::ArrayXd x =
      Eigen::Map<const Eigen::ArrayXd>(own.data(), static_cast<Eigen::Index>(own.size()));
  if (signal_ == "v") x = x.abs();
  if (signal_ == "d") x = (x / farthest_ + kNearest).unaryExpr(&elementary::log);
  return x;
}

Eigen::ArrayXd SignalAxis::unit(const Observations& rows) const {
  return ((values(rows) - low_) / (high_ - low_)).max(-0.1).min(1.1);
}

Eigen::MatrixXd radial_columns(const Eigen::ArrayXd& unit, Eigen::Index centres) {
  Eigen::MatrixXd out(unit.size(), centres);
  const auto spaces = static_cast<double>(centres - 1);
  for (Eigen::Index k = 0; k < centres; ++k) {
    for (Eigen::Index i = 0; i < unit.size(); ++i) {
      const double apart = unit[i] * spaces - static_cast<double>(k);
      out(i, k) = std::abs(apart) < kReach ? elementary::exp(-0.5 * apart * apart) : 0;
    }
  }
  return out;
}

Eigen::MatrixXd column_products(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  Eigen::MatrixXd out(first.rows(), first.cols() * second.cols());
  for (Eigen::Index i = 0; i < first.cols(); ++i) {
    for (Eigen::Index j = 0; j < second.cols(); ++j) {
      out.col(i * second.cols() + j) = first.col(i).cwiseProduct(second.col(j));
    }
  }
  return out;
}

}  // namespace tribench::loop
