// SPDX-License-Identifier: MIT
//
// Takes the noise's memory out of the rows: each row less what the rows of its movement before it
// foretell (a Kalman filter of the noise's slow part, which is steady after a few rows), then the
// part along the movement's offset shrunk by what is known of offsets, then the movement's weight.
// Noise comes out with Noise::row_variance(), uncorrelated.
//
// Source: Kalman 1960; random-intercept quasi-demeaning (Fuller and Battese 1973) after
// pre-whitening of neighbouring rows (Prais and Winsten 1954); specification, section 3.1 to 3.3,
// whose optional whitening and weights by movement are the rule here. We differ in that the
// intercept belongs to the movement, not to the stretch: stretches of one movement share their
// offset.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/noise.hpp"

namespace tribench::loop {

// What is done to the rows y[0], y[1], ... of a movement, one after the other:
//   e[0] = y[0],  e[k] = y[k] - carried() y[k-1] + returned(k) e[k-1],  and scale(k) e[k] comes
//   out.
// Of noise that is not to be whitened it changes nothing.
class RowFilter {
 public:
  // Exact for movements of up to `longest` rows.
  RowFilter(const Noise& noise, std::size_t longest);

  double carried() const { return carried_; }
  double returned(std::size_t k) const { return at(returned_, k); }
  double scale(std::size_t k) const { return at(scale_, k); }
  // What comes out of rows that are all 1: a movement's offset, before it is weighed.
  double offset(std::size_t k) const { return at(offset_, k); }
  // From this row on all of these are what they are there.
  std::size_t steady_from() const { return scale_.size() - 1; }

 private:
  static double at(const std::vector<double>& of, std::size_t k) {
    return k < of.size() ? of[k] : of.back();
  }
  double carried_ = 0;
  std::vector<double> returned_;
  std::vector<double> scale_;
  std::vector<double> offset_;
};

// A movement's offset in filtered rows: the part of the rows along it is shrunk to the share
// `kept`.
struct OffsetShrinkage {
  double length;  // of the direction, squared
  double noise;   // variance along it, without the offset's own
  double offset;  // the offset's own
  double kept;
};

class Whitening {
 public:
  // clusters and noise are kept by reference.
  Whitening(const Clusters& clusters, const Noise& noise);

  const RowFilter& filter() const { return filter_; }
  OffsetShrinkage offset_of(std::size_t movement) const;
  Eigen::MatrixXd of(Eigen::MatrixXd columns) const;
  // Without the memory alone: offsets and weights are as they were.
  Eigen::MatrixXd filtered(Eigen::MatrixXd columns) const;
  // Of rows that have been whitened: their product with any whitened column is what comes out here
  // times that column as it was.
  Eigen::VectorXd adjoint(Eigen::VectorXd rows) const;

  // ln of what the offsets add to the spread of each movement's mean, halved and shared out to its
  // stretches: the part of a negative log likelihood that says how well offsets are explained.
  Eigen::VectorXd offset_nats() const;

 private:
  template <int kColumns>
  void filter_columns(double* first, Eigen::Index stride, std::size_t rows) const;
  // Of one movement.
  void filter_rows(Eigen::Ref<Eigen::MatrixXd> rows) const;
  void filter_backwards(Eigen::Ref<Eigen::VectorXd> rows) const;
  void shrink_offset(std::size_t movement, Eigen::Ref<Eigen::MatrixXd> rows) const;

  const Clusters& clusters_;
  const Noise& noise_;
  RowFilter filter_;
  // The offset's direction in the filtered rows of the longest movement: a shorter one has its
  // first rows. And the square of its length up to each row, to where the filter is steady.
  Eigen::VectorXd direction_;
  std::vector<double> squares_until_;
};

// The same in one call.
Eigen::MatrixXd whitened(Eigen::MatrixXd columns, const Clusters& clusters, const Noise& noise);
Eigen::VectorXd offset_nats(const Clusters& clusters, const Noise& noise);

}  // namespace tribench::loop
