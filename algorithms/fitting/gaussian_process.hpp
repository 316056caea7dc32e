// SPDX-License-Identifier: MIT
//
// Gaussian-process regression: a smooth stand-in for an unknown function, from noisy rows. The
// covariance at x and x' is, in units of the function's variance,
//
//   exp(-|x - x'|^2 / (2 length^2)) + constant + noise * [same row]
//
// For some hundreds of rows: training takes rows^3 / 3 multiplications. Not for choosing between
// formulas; udsr looks into it where there are no data, pysr smooths its target with it.
//
// Source: Rasmussen & Williams 2006, algorithm 2.1, equations 2.25 (mean), 5.8, 5.9 (likelihood and
// its gradient), 5.12 (leave-one-out in closed form). The variance is not searched: at its best
// value, y' K^-1 y / n, the likelihood no longer depends on it, nor does the mean ever.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foundation/random.hpp"

namespace tribench {

// Centres every input and brings it to unit spread; one that does not vary keeps its own.
struct Standardisation {
  Eigen::VectorXd center;
  Eigen::VectorXd spread;

  explicit Standardisation(const Eigen::MatrixXd& points);
  Eigen::MatrixXd rows(const Eigen::MatrixXd& points) const;
  Eigen::VectorXd point(const Eigen::VectorXd& point) const;
};

// What a covariance is made of; points are to be divided by the lengths.
struct Covariance {
  Eigen::VectorXd lengths;  // one per input
  double noise = 0;         // variance of the noise / variance of the function
  double constant = 0;      // variance of a common offset / variance of the function
};

class GaussianProcess {
 public:
  // points: n x d, all finite; target: n, usually less its mean. False where the covariance is not
  // positive definite to rounding: then nothing else may be asked.
  bool train(const Eigen::MatrixXd& points, const Eigen::VectorXd& target, double length,
             double noise, double constant = 0);

  // Variance of the function where it is likeliest.
  double variance() const { return variance_; }
  // Posterior mean of the function at a point. O(n d).
  double mean_at(const Eigen::VectorXd& point) const;
  // |target - mean| at each row, had the row been left out. O(n^3).
  std::vector<double> leave_one_out_errors() const;

 private:
  Eigen::MatrixXd points_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd weights_;
  double variance_ = 0;
  double length_ = 1;
  double constant_ = 0;
};

// Log of the marginal likelihood at the best variance; minus infinity where the covariance is not
// positive definite to rounding. Writes the derivatives by the logarithms of lengths, noise and
// constant, in this order, where gradient is not null. O(n^3).
double log_likelihood(const Eigen::MatrixXd& points, const Eigen::VectorXd& target,
                      const Covariance& covariance, Eigen::VectorXd* gradient = nullptr);

// The covariance of the largest marginal likelihood that is found from lengths of 1, noise of 0.1
// and a constant of 1, and from `restarts` random starts: the likelihood is looked at at all, and
// climbed from the best few. Points and target standardised, at least 2 rows. Deterministic.
Covariance most_likely_covariance(const Eigen::MatrixXd& points, const Eigen::VectorXd& target,
                                  int restarts, RandomStream random);

// How often that looks at the likelihood, at most.
std::uint64_t most_likelihoods(int restarts);

}  // namespace tribench
