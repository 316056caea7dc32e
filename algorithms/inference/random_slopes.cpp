// SPDX-License-Identifier: MIT
#include "algorithms/inference/random_slopes.hpp"

#include <algorithm>
#include <cmath>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"
#include "algorithms/inference/flips.hpp"
#include "algorithms/inference/noise.hpp"
#include "algorithms/inference/score_test.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kParts = 5;
constexpr std::size_t kFewestRows = 10;  // that foretell a part
// Correlation times between a part and the rows that foretell it: beyond them noise that lasts
// foretells nothing.
constexpr double kGap = 2;
// Of the mean square of a column: shrinks what a movement says of a column by a tenth where it
// excites it as usual, and by more where it hardly does.
constexpr double kSlopeRidge = 0.1;

// Sums of the products of [1 columns residual].
using Moments = Eigen::MatrixXd;

// Of unit root mean square; zeros stay zeros.
Eigen::VectorXd scales_of(const Eigen::MatrixXd& columns) {
  Eigen::VectorXd scales =
      (columns.colwise().squaredNorm() / static_cast<double>(columns.rows())).cwiseSqrt();
  for (double& scale : scales) scale = scale > 0 ? scale : 1;
  return scales;
}

// Intercept and slopes that fit these rows, the slopes shrunk.
Eigen::VectorXd fit(const Moments& moments) {
  const Eigen::Index columns = moments.rows() - 2;
  const double rows = moments(0, 0);
  const Eigen::VectorXd means = moments.col(0).tail(columns + 1) / rows;
  Eigen::MatrixXd centred = moments.bottomRightCorner(columns + 1, columns + 1);
  centred -= rows * means * means.transpose();
  Eigen::MatrixXd gram = centred.topLeftCorner(columns, columns);
  gram.diagonal().array() += kSlopeRidge * rows;
  const Eigen::VectorXd slopes = solve_symmetric(gram, centred.col(columns).head(columns));
  Eigen::VectorXd all(columns + 1);
  all << means[columns] - means.head(columns).dot(slopes), slopes;
  return all;
}

double squared_error(const Moments& moments, const Eigen::VectorXd& coefficients) {
  Eigen::VectorXd weights(coefficients.size() + 1);
  weights << -coefficients, 1;
  return weights.dot(moments * weights);
}

// Each movement's own fit of a term, offset and slopes.
class MovementFits {
 public:
  MovementFits(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
               std::span<const RowRange> movements);

  // What rows of a movement foretell of other rows of it, `gap` rows and more away: the share of
  // the squared error about the foretold mean.
  struct Foretold {
    double gain = 0;
    double squares = 0;
    double share() const { return squares > 0 ? gain / squares : 0; }
  };
  [[nodiscard]] Foretold foretold(const RowRange& movement, std::size_t gap) const;

  // movements x columns
  const Eigen::MatrixXd& slopes() const { return slopes_; }
  // What all movements' own fits leave.
  const Eigen::VectorXd& left() const { return left_; }

 private:
  Moments moments(std::size_t begin, std::size_t end) const {
    if (begin >= end) return Moments::Zero(rows_.cols(), rows_.cols());
    return gram_of(
        rows_.middleRows(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin)));
  }

  Eigen::MatrixXd rows_;  // [1 columns residual], the columns of unit root mean square
  Eigen::MatrixXd slopes_;
  Eigen::VectorXd left_;
};

MovementFits::MovementFits(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                           std::span<const RowRange> movements)
    : rows_(residual.size(), columns.cols() + 2),
      slopes_(static_cast<Eigen::Index>(movements.size()), columns.cols()),
      left_(residual) {
  const Eigen::VectorXd scales = scales_of(columns);
  rows_ << Eigen::VectorXd::Ones(residual.size()), columns * scales.cwiseInverse().asDiagonal(),
      residual;
  for (std::size_t m = 0; m < movements.size(); ++m) {
    const RowRange& movement = movements[m];
    const Eigen::VectorXd own = fit(moments(movement.begin, movement.end));
    slopes_.row(static_cast<Eigen::Index>(m)) =
        own.tail(columns.cols()).cwiseQuotient(scales).transpose();
    const auto begin = static_cast<Eigen::Index>(movement.begin);
    const auto size = static_cast<Eigen::Index>(movement.size());
    left_.segment(begin, size) -= rows_.block(begin, 0, size, own.size()) * own;
  }
}

MovementFits::Foretold MovementFits::foretold(const RowRange& movement, std::size_t gap) const {
  Foretold out;
  for (std::size_t k = 0; k < kParts; ++k) {
    const std::size_t begin = movement.begin + movement.size() * k / kParts;
    const std::size_t end = movement.begin + movement.size() * (k + 1) / kParts;
    const std::size_t before = begin - std::min(begin - movement.begin, gap);
    const std::size_t after = end + std::min(movement.end - end, gap);
    const Moments rest = moments(movement.begin, before) + moments(after, movement.end);
    if (rest(0, 0) < static_cast<double>(kFewestRows)) continue;
    const Moments part = moments(begin, end);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(part.rows() - 1);
    mean[0] = rest(0, rest.cols() - 1) / rest(0, 0);
    const double about_mean = squared_error(part, mean);
    out.squares += about_mean;
    out.gain += about_mean - squared_error(part, fit(rest));
  }
  return out;
}

}  // namespace

std::vector<RandomSlopes> random_slopes(std::span<const Eigen::MatrixXd> terms,
                                        const Eigen::VectorXd& residual,
                                        std::span<const RowRange> movements, std::size_t flips,
                                        RandomStream random) {
  std::vector<RandomSlopes> all;
  FloatRows shares(static_cast<Eigen::Index>(movements.size()),
                   static_cast<Eigen::Index>(terms.size()));
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const MovementFits fits(terms[k], residual, movements);
    const auto gap =
        static_cast<std::size_t>(std::ceil(kGap * correlation_time(fits.left(), movements)));
    MovementFits::Foretold whole;
    double sum = 0;
    for (std::size_t m = 0; m < movements.size(); ++m) {
      const MovementFits::Foretold one = fits.foretold(movements[m], gap);
      shares(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(k)) =
          static_cast<float>(one.share());
      sum += one.share();
      whole.gain += one.gain;
      whole.squares += one.squares;
    }
    all.push_back({sum / static_cast<double>(movements.size()), whole.share(), 1, fits.slopes()});
  }
  if (terms.empty()) return all;
  const FloatRows sums = Flips(flips, movements.size(), std::move(random)).sums(shares, 0, flips);
  const Eigen::VectorXf largest = sums.rowwise().maxCoeff() / static_cast<float>(movements.size());
  const std::vector<double> maxima(largest.begin(), largest.end());
  constexpr double kTie = 1 - 1e-5;  // the flips' sums are rounded
  for (RandomSlopes& one : all) {
    if (one.mean_share > 0) one.p = adjusted_p(kTie * one.mean_share, maxima);
  }
  return all;
}

}  // namespace tribench::loop
