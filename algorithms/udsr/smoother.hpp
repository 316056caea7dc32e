// SPDX-License-Identifier: MIT
//
// A smooth stand-in for the unknown function, with a known held-out error: Gaussian-process
// regression with a squared-exponential kernel on at most kMaxRows rows. Recursive simplification
// asks it for values where there are no data.
//
// Length and noise are those of the least held-out error on a grid (fitting/gaussian_process.hpp
// has it in closed form). AI-Feynman trains a network here, whose held-out error is not known.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/fitting/gaussian_process.hpp"
#include "foundation/random.hpp"

namespace tribench::udsr {

class Smoother {
 public:
  static constexpr std::size_t kMaxRows = 250;

  // All values finite. Rows are drawn by `random` where there are more than kMaxRows.
  Smoother(const Inputs& inputs, std::span<const double> target, RandomStream random);

  // Median absolute leave-one-out error, in the target's unit.
  double held_out_error() const { return held_out_error_; }

  std::size_t rows() const { return static_cast<std::size_t>(points_.rows()); }
  // Row r of the points it was trained on, in the inputs' units, and the target there.
  Eigen::VectorXd point(std::size_t r) const { return raw_.row(static_cast<Eigen::Index>(r)); }
  double target(std::size_t r) const { return target_[static_cast<Eigen::Index>(r)]; }
  // The box of the points, in the inputs' units.
  Eigen::VectorXd low() const { return raw_.colwise().minCoeff().transpose(); }
  Eigen::VectorXd high() const { return raw_.colwise().maxCoeff().transpose(); }
  double predict(const Eigen::VectorXd& point) const;

 private:
  void train(double length, double noise);

  Eigen::MatrixXd raw_;
  Eigen::MatrixXd points_;  // standardised
  Eigen::VectorXd target_;
  std::optional<Standardisation> scale_;
  GaussianProcess process_;
  double mean_ = 0;
  double held_out_error_ = 0;
};

}  // namespace tribench::udsr
