// SPDX-License-Identifier: MIT
//
// The score test of a flexible basis of many features, each with and without the direction of
// motion: what score_block says of [F, s F], in single precision (which a ridge of per cents
// forgives) and in a fraction of the time. Internal to the room.
//
// [F, s F] spans what the features of either direction span, [F (1 + s)/2, F (1 - s)/2], and the
// statistic with its ridge is the same in both. There a row has but half of the columns; what the
// other half still foretells after a reversal is one row of columns that fades. The movements'
// offsets and the model's basis are taken out of the products, not out of the rows.
// Sums run in the order of the rows on every machine.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/flips.hpp"
#include "algorithms/inference/noise.hpp"
#include "algorithms/inference/score_test.hpp"
#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {

class FeatureScorer {
 public:
  // basis: orthonormal, of the whitened model; residual: whitened, orthogonal to it. direction:
  // -1, 0 or 1 a row; empty: features without direction. clusters are kept by reference.
  FeatureScorer(const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual,
                const Clusters& clusters, const Noise& noise, const Eigen::VectorXf& direction);

  // features: rows x features, not whitened. ridge: as a share of the mean diagonal.
  BlockScores score(const FloatRows& features, double ridge) const;

 private:
  // Neighbouring rows of one stretch and one direction; a row without a direction stands alone.
  struct Run {
    std::size_t begin;
    std::size_t end;
    std::size_t stretch;
    int half;  // 0 forwards, 1 backwards
    bool both;
  };
  struct Movement {
    std::size_t begin;
    std::vector<Run> runs;
    OffsetShrinkage offset;
  };
  struct Sums;
  struct Fading;

  void add_movement_of(std::size_t m, const Whitening& whitening);
  void cut_into_runs();
  float part_of(std::size_t row, std::size_t half) const;
  void begin_row(const FloatRows& features, const Movement& movement, std::size_t row,
                 std::size_t half, float* missed) const;
  void add_run(const FloatRows& features, const Movement& movement, const Run& run, float weight,
               Sums& sums) const;
  Fading fading_of(const Movement& movement, const Run& run, float weight) const;
  void add_other_half(const FloatRows& features, const Movement& movement, const Run& run,
                      float weight, Sums& sums) const;
  void add_row_of_both(const FloatRows& features, const Movement& movement, const Run& run,
                       float weight, Sums& sums) const;
  void take_offset_out(const Movement& movement, Sums& sums) const;
  void add_movement(const FloatRows& features, std::size_t m, Sums& sums) const;

  const Clusters& clusters_;
  RowFilter filter_;
  Eigen::VectorXf direction_;
  Eigen::Index basis_columns_;
  std::vector<Movement> movements_;
  // What a row's features are multiplied by: the basis, the offset's direction, the residual;
  // zeros up to a multiple of four.
  FloatRows left_;
  Eigen::MatrixXf along_offset_;  // per stretch: the sum over its rows of left_ times the offset's
  Eigen::MatrixXf along_residual_;  // ... and times the residual, the basis alone
};

}  // namespace tribench::loop
