// SPDX-License-Identifier: MIT
//
// Gram matrices of whitened columns for any spread of the movements' offsets. What the noise's
// memory makes of the rows does not hang on that spread, and what is shrunk along an offset is one
// direction a movement: once the rows have been filtered each further spread costs no pass over
// them. For the question how far a candidate lowers that spread, asked of many candidates beside
// one model.
//
// Source: a random intercept's Gram matrix is that of the filtered rows less one product a movement
// (Fuller and Battese 1973; whitening.hpp).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/cross_validation.hpp"
#include "algorithms/inference/noise.hpp"

namespace tribench::loop {

// What is known of [x y] by stretch and movement; clusters are kept by reference.
class OffsetGrams {
 public:
  OffsetGrams(const Clusters& clusters, const Noise& noise) : clusters_(&clusters), noise_(noise) {}

  // The Gram matrices of the columns whitened by the noise with this spread in place of its own.
  // Cost: stretches x columns^2.
  StretchGrams at(double between_sd) const;
  // b of the least squares in such rows. Cost: movements x columns^2.
  Eigen::VectorXd coefficients_at(double between_sd) const;
  // The spread of the offsets that y - x b leaves.
  double spread_beside(const Eigen::VectorXd& b) const;

 private:
  friend class FilteredModel;
  void sum_up_movements();

  const Clusters* clusters_;
  Noise noise_;
  StretchGrams filtered_;   // of filtered rows
  Eigen::MatrixXd along_;   // their products with the offset's direction, columns x stretches
  Eigen::VectorXd square_;  // of the direction, by stretch
  StretchGrams filtered_of_movement_;
  Eigen::MatrixXd along_movement_;  // columns x movements
  Eigen::MatrixXd means_;           // of the rows as they are, columns x movements
};

// A model's columns and what it leaves over, filtered once for all candidates.
class FilteredModel {
 public:
  // x: rows x columns, y: rows, as they are. clusters are kept by reference.
  FilteredModel(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const Clusters& clusters,
                const Noise& noise);
  // Of [x more y]. Cost: rows x columns x more columns.
  OffsetGrams beside(const Eigen::MatrixXd& more) const;

 private:
  Eigen::MatrixXd x_;
  Eigen::VectorXd y_;
  OffsetGrams own_;  // of [x y]
};

}  // namespace tribench::loop
