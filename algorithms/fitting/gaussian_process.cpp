// SPDX-License-Identifier: MIT
#include "algorithms/fitting/gaussian_process.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "algorithms/fitting/nlopt_minimizer.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

// Bounds of the search, for standardised points: a length below a twentieth of the spread is no
// smoothing, one of a hundred is a plane.
constexpr double kShortest = 0.05;
constexpr double kLongest = 100;
constexpr double kLeastNoise = 1e-8;
constexpr double kMostNoise = 100;
constexpr double kLeastConstant = 1e-3;
constexpr double kMostConstant = 1e3;

constexpr std::size_t kClimbs = 4;
constexpr std::uint64_t kClimbEvaluations = 40;

Eigen::MatrixXd squared_distances(const Eigen::MatrixXd& points) {
  const Eigen::VectorXd norms = points.rowwise().squaredNorm();
  Eigen::MatrixXd distances = -2 * points * points.transpose();
  distances.colwise() += norms;
  distances.rowwise() += norms.transpose();
  return distances.cwiseMax(0);
}

Eigen::MatrixXd correlations(const Eigen::MatrixXd& points, double length) {
  return (squared_distances(points).array() * (-0.5 / (length * length)))
      .unaryExpr(&elementary::exp)
      .matrix();
}

// The logarithms that the likelihood is searched over.
Covariance covariance_of(std::span<const double> logs) {
  const auto d = static_cast<Eigen::Index>(logs.size()) - 2;
  Covariance covariance{Eigen::VectorXd(d), elementary::exp(logs[logs.size() - 2]),
                        elementary::exp(logs.back())};
  for (Eigen::Index j = 0; j < d; ++j) {
    covariance.lengths[j] = elementary::exp(logs[static_cast<std::size_t>(j)]);
  }
  return covariance;
}

Bounds bounds_of(std::size_t inputs) {
  Bounds bounds{std::vector<double>(inputs, elementary::log(kShortest)),
                std::vector<double>(inputs, elementary::log(kLongest))};
  bounds.low.insert(bounds.low.end(),
                    {elementary::log(kLeastNoise), elementary::log(kLeastConstant)});
  bounds.high.insert(bounds.high.end(),
                     {elementary::log(kMostNoise), elementary::log(kMostConstant)});
  return bounds;
}

}  // namespace

Standardisation::Standardisation(const Eigen::MatrixXd& points)
    : center(points.colwise().mean().transpose()) {
  const Eigen::MatrixXd centred = points.rowwise() - center.transpose();
  const auto n = static_cast<double>(points.rows());
  spread = (centred.colwise().squaredNorm() / n).cwiseSqrt().transpose();
  for (double& s : spread) {
    if (!(s > 0)) s = 1;
  }
}

Eigen::MatrixXd Standardisation::rows(const Eigen::MatrixXd& points) const {
  const Eigen::MatrixXd centred = points.rowwise() - center.transpose();
  return centred.array().rowwise() / spread.transpose().array();
}

Eigen::VectorXd Standardisation::point(const Eigen::VectorXd& point) const {
  return (point - center).cwiseQuotient(spread);
}

bool GaussianProcess::train(const Eigen::MatrixXd& points, const Eigen::VectorXd& target,
                            double length, double noise, double constant) {
  points_ = points;
  length_ = length;
  constant_ = constant;
  Eigen::MatrixXd kernel = correlations(points, length);
  if (constant > 0) kernel.array() += constant;
  kernel.diagonal().array() += noise;
  factor_.compute(kernel);
  if (factor_.info() != Eigen::Success) return false;
  weights_ = factor_.solve(target);
  variance_ = target.dot(weights_) / static_cast<double>(points.rows());
  return true;
}

double GaussianProcess::mean_at(const Eigen::VectorXd& point) const {
  const Eigen::VectorXd distances = (points_.rowwise() - point.transpose()).rowwise().squaredNorm();
  const Eigen::ArrayXd kernel =
      (distances.array() * (-0.5 / (length_ * length_))).unaryExpr(&elementary::exp);
  return kernel.matrix().dot(weights_) + constant_ * weights_.sum();
}

std::vector<double> GaussianProcess::leave_one_out_errors() const {
  const Eigen::MatrixXd inverse =
      factor_.solve(Eigen::MatrixXd::Identity(points_.rows(), points_.rows()));
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < weights_.size(); ++i) {
    errors.push_back(std::abs(weights_[i] / inverse(i, i)));
  }
  return errors;
}

double log_likelihood(const Eigen::MatrixXd& points, const Eigen::VectorXd& target,
                      const Covariance& covariance, Eigen::VectorXd* gradient) {
  const Eigen::Index n = points.rows();
  const Eigen::MatrixXd scaled = points.array().rowwise() / covariance.lengths.transpose().array();
  const Eigen::MatrixXd smooth = correlations(scaled, 1);
  Eigen::MatrixXd kernel = smooth.array() + covariance.constant;
  kernel.diagonal().array() += covariance.noise;
  const Eigen::LLT<Eigen::MatrixXd> factor(kernel);
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  const Eigen::VectorXd weights = factor.solve(target);
  const double variance = target.dot(weights) / static_cast<double>(n);
  const double log_determinant =
      2 * factor.matrixLLT().diagonal().array().unaryExpr(&elementary::log).sum();
  if (gradient != nullptr) {
    // dL / dtheta = tr((w w' / variance - K^-1) dK / dtheta) / 2, equation 5.9.
    Eigen::MatrixXd slope = weights * weights.transpose() / variance;
    slope -= factor.solve(Eigen::MatrixXd::Identity(n, n));
    const Eigen::MatrixXd smooth_slope = slope.cwiseProduct(smooth);
    const Eigen::VectorXd sums = smooth_slope.rowwise().sum();
    const Eigen::Index d = points.cols();
    gradient->resize(d + 2);
    for (Eigen::Index j = 0; j < d; ++j) {
      const Eigen::VectorXd x = scaled.col(j);
      (*gradient)[j] = sums.dot(x.cwiseAbs2()) - x.dot(smooth_slope * x);
    }
    (*gradient)[d] = 0.5 * covariance.noise * slope.trace();
    (*gradient)[d + 1] = 0.5 * covariance.constant * slope.sum();
  }
  return -0.5 * (static_cast<double>(n) * elementary::log(variance) + log_determinant);
}

Covariance most_likely_covariance(const Eigen::MatrixXd& points, const Eigen::VectorXd& target,
                                  int restarts, RandomStream random) {
  const auto inputs = static_cast<std::size_t>(points.cols());
  const Bounds bounds = bounds_of(inputs);
  const Objective against = [&](std::span<const double> logs, std::span<double> gradient) {
    Eigen::VectorXd slope;
    const double value =
        log_likelihood(points, target, covariance_of(logs), gradient.empty() ? nullptr : &slope);
    for (std::size_t k = 0; k < gradient.size(); ++k) {
      gradient[k] = slope.size() == 0 ? 0 : -slope[static_cast<Eigen::Index>(k)];
    }
    return -value;
  };
  struct Start {
    std::vector<double> logs;
    double against;
  };
  std::vector<Start> starts;
  for (int i = 0; i <= restarts; ++i) {
    std::vector<double> logs(inputs, 0.0);
    logs.insert(logs.end(), {elementary::log(0.1), 0.0});
    for (std::size_t k = 0; i > 0 && k < logs.size(); ++k) {
      logs[k] = random.uniform(bounds.low[k], bounds.high[k]);
    }
    const double value = against(logs, {});
    starts.push_back({std::move(logs), value});
  }
  std::ranges::stable_sort(starts, {}, &Start::against);
  Start best = starts[0];
  MinimizeOptions options;
  options.max_evaluations = kClimbEvaluations;
  options.value_tolerance = 1e-6;
  for (std::size_t i = 0; i < std::min(kClimbs, starts.size()); ++i) {
    const Minimum minimum =
        minimize_nlopt(NloptMethod::lbfgs, against, starts[i].logs, bounds, options);
    if (minimum.value < best.against) best = {minimum.x, minimum.value};
  }
  return covariance_of(best.logs);
}

std::uint64_t most_likelihoods(int restarts) {
  return 1 + static_cast<std::uint64_t>(restarts) + kClimbs * kClimbEvaluations;
}

}  // namespace tribench
