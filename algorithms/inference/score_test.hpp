// SPDX-License-Identifier: MIT
//
// Is there more in the residual than noise, and where? A score test for each candidate block of
// columns, its null distribution from sign flips of whole clusters, all candidates in one currency
// and the maximum over them as the reference: the family-wise error is kept under any dependence
// between the candidates, correlation within a cluster and unequal variances.
//
// Not for ranking strong candidates: the statistic is bounded by the number of clusters. Rank by
// the cross-validated gain.
//
// Source: Cameron, Gelbach and Miller 2008 (wild cluster); Westfall and Young 1993 (max
// statistic); Shah and Peters 2020 (both sides residualised). Specification, section 3.4.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "algorithms/inference/flips.hpp"
#include "algorithms/inference/gamma_tail.hpp"

namespace tribench::loop {

// A block of `count` columns from `first` on.
struct Block {
  std::size_t first = 0;
  std::size_t count = 0;
};

struct BlockTest {
  double statistic = 0;           // sum of squares that the block explains
  double score = 0;               // -log10 of the matched tail
  double share = 0;               // rms of the block that survives projection on the model
  double effective_clusters = 0;  // (sum h)^2 / sum h^2 of the clusters' sums of squares h
  std::size_t carrying = 0;       // clusters with at least a tenth of the mean h
  double information = 0;         // sum of squares that survives, the mean over the columns
  bool testable = false;          // at least 1e-3 of the sum of squares survives
};

// Orthonormal basis of the columns of x, those that depend on others left out.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& x);

// Sums over clusters of u_c = Zt_c' r_c in coordinates in which Zt'Zt (+ ridge) is the identity:
// the statistic is the squared length of the sum over clusters.
struct BlockScores {
  FloatRows whitened_sums;  // clusters x columns kept
  BlockTest test;
  MatchedGamma gamma{0, 0};
};

// Of every block of columns of z (rows x columns, whitened; finite) beside a model with this basis
// and residual, which is orthogonal to it. A column that is all but in the basis is left out of its
// block. Cost: rows x columns x basis, once.
std::vector<BlockScores> score_blocks(const Eigen::MatrixXd& z, std::span<const Block> blocks,
                                      const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual,
                                      const Clusters& clusters);
// All columns as one block.
BlockScores score_block(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis,
                        const Eigen::VectorXd& residual, const Clusters& clusters);
// The statistic alone, in one reading of the basis: for what looks at hundreds of blocks one after
// another. 0 where all columns are all but in the basis.
double score_statistic(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis,
                       const Eigen::VectorXd& residual);
// All columns as one block with every stretch counting alike, whatever it holds of the block. For a
// block that a few stretches hold nearly all of: k of them have 2^k signs, so that its plain p
// stays above 2^-k whatever the many others say.
BlockScores score_block_evenly(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis,
                               const Eigen::VectorXd& residual, const Clusters& clusters);

// [a b]
Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// The same from the products: gram = Zt'Zt (the lower triangle is read), sums: clusters x columns.
BlockScores score_sums(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& sums, double ridge);

// z - basis basis' z
Eigen::MatrixXd project_off(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis);

// For each flip the largest score over all blocks. stop_above, stop_count: give up once so many
// maxima (of the first flips) are at least stop_above; 0 never. Returns the maxima computed.
std::vector<double> flip_maxima(std::span<BlockScores> blocks, const Flips& flips,
                                double stop_above = 0, std::size_t stop_count = 0);

// The least score that has an adjusted p of at most alpha.
double critical_score(std::vector<double> maxima, double alpha);

// (1 + number of maxima >= score) / (1 + number of maxima)
double adjusted_p(double score, std::span<const double> maxima);

}  // namespace tribench::loop
