// SPDX-License-Identifier: MIT
//
// Smooth functions of a signal whose places are settled on a reference: the same row gives the same
// columns whatever is recorded before or after it, so that sums over rows can grow.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "problems/preparation/observations.hpp"

namespace tribench::loop {

class SignalAxis {
 public:
  // The interval is the middle 99 % of the reference's values: of |v| for the velocity, of the
  // logarithm of a distance since reversal.
  SignalAxis(const Observations& reference, std::string_view signal);

  const std::string& signal() const { return signal_; }
  bool varies() const { return high_ > low_; }
  // 0 to 1 over the interval, at most a tenth beyond it.
  Eigen::ArrayXd unit(const Observations& rows) const;

 private:
  Eigen::ArrayXd values(const Observations& rows) const;

  std::string signal_;
  double farthest_ = 1;  // distance since reversal
  double low_ = 0;
  double high_ = 0;
};

// Gaussian radial functions about `centres` >= 2 evenly spread places, as wide as these are apart.
Eigen::MatrixXd radial_columns(const Eigen::ArrayXd& unit, Eigen::Index centres);

// All products of a column of the one and a column of the other.
Eigen::MatrixXd column_products(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second);

}  // namespace tribench::loop
