// SPDX-License-Identifier: MIT
#include "algorithms/inference/score_test.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"

namespace tribench::loop {
namespace {

constexpr double kSmallestShare = 1e-3;  // of the sum of squares
constexpr std::size_t kFlipsAtOnce = 250;
// Of the mean over the stretches: one that holds less of a block's squares has no say of its own.
constexpr double kHoldsLittle = 0.01;
// Of a column's square: less beside the others is rounding.
constexpr double kDependent = 1e-11;

// Lower Cholesky factor of the Gram matrix of zt with a ridge; columns have unit length before
// projection, so the tiny floor is relative.
Eigen::MatrixXd factor_of(const Eigen::MatrixXd& gram, double ridge) {
  Eigen::MatrixXd loaded = gram;
  const double mean = gram.trace() / static_cast<double>(gram.rows());
  loaded.diagonal().array() += ridge * mean + 1e-10 * mean;
  return loaded.llt().matrixL();
}

void count_clusters(BlockTest& test, const Eigen::VectorXd& h) {
  const double sum = h.sum();
  const double squares = h.squaredNorm();
  test.effective_clusters = squares > 0 ? sum * sum / squares : 0;
  const double threshold = 0.1 * sum / static_cast<double>(h.size());
  test.carrying = static_cast<std::size_t>((h.array() > threshold).count());
}

// The sums in the coordinates of the statistic, its matched null and the score.
void finish_scores(BlockScores& block, const Eigen::MatrixXd& gram, const Eigen::MatrixXd& raw,
                   double ridge) {
  const Eigen::MatrixXd factor = factor_of(gram, ridge);
  const Eigen::MatrixXd sums =
      factor.triangularView<Eigen::Lower>().solve(raw.transpose()).transpose();
  block.whitened_sums = sums.cast<float>();
  block.test.statistic = sums.colwise().sum().squaredNorm();
  // Moments of the flipped statistic |sum eps_c v_c|^2 over all flips.
  const Eigen::VectorXd lengths = sums.rowwise().squaredNorm();
  const double mean = lengths.sum();
  const double variance = 2 * ((sums.transpose() * sums).squaredNorm() - lengths.squaredNorm());
  block.gamma = MatchedGamma(mean, variance);
  block.test.score = block.gamma.score(block.test.statistic);
}

// The sums of all testable blocks: one product with the flips serves them all.
FloatRows side_by_side(std::span<const BlockScores> blocks) {
  Eigen::Index rows = 0;
  Eigen::Index columns = 0;
  for (const BlockScores& block : blocks) {
    if (!block.test.testable) continue;
    rows = block.whitened_sums.rows();
    columns += block.whitened_sums.cols();
  }
  FloatRows all(rows, columns);
  Eigen::Index column = 0;
  for (const BlockScores& block : blocks) {
    if (!block.test.testable) continue;
    all.middleCols(column, block.whitened_sums.cols()) = block.whitened_sums;
    column += block.whitened_sums.cols();
  }
  return all;
}

// The largest score of many blocks is hardly ever less: what scores less in one need not be known.
constexpr double kUsualScore = 1;

// The largest score over the testable blocks, flip after flip.
class LargestScore {
 public:
  explicit LargestScore(std::span<BlockScores> blocks) {
    for (BlockScores& block : blocks) {
      if (!block.test.testable) continue;
      const double mean = block.whitened_sums.cast<double>().squaredNorm();
      block.gamma.tabulate(std::max(block.test.statistic, 12 * mean));
      // Rounded down: less is looked at, and scores what it scores.
      const auto least = static_cast<float>((1 - 1e-6) * block.gamma.none_below(kUsualScore));
      blocks_.push_back({&block.gamma, block.whitened_sums.cols(), least});
    }
    statistics_.resize(blocks_.size());
  }

  // sums: of one flip, block after block.
  double of(const float* sums) {
    double largest = 0;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      float statistic = 0;
      for (const float* end = sums + blocks_[k].columns; sums < end; ++sums) {
        statistic += *sums * *sums;
      }
      statistics_[k] = statistic;
      if (!(statistic < blocks_[k].least)) largest = std::max(largest, score(k));
    }
    if (largest >= kUsualScore) return largest;
    for (std::size_t k = 0; k < blocks_.size(); ++k) largest = std::max(largest, score(k));
    return largest;
  }

 private:
  struct Block {
    MatchedGamma* gamma;
    Eigen::Index columns;
    float least;  // statistic that may have the usual score
  };

  double score(std::size_t k) const {
    return blocks_[k].gamma->fast_score(static_cast<double>(statistics_[k]));
  }

  std::vector<Block> blocks_;
  std::vector<float> statistics_;
};

}  // namespace

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& x) {
  return x.cols() == 0 ? x : orthonormal_columns(x, kDependent);
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out(a.rows(), a.cols() + b.cols());
  out << a, b;
  return out;
}

Eigen::MatrixXd project_off(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis) {
  if (basis.cols() == 0) return z;
  return less_combination(z, basis, cross_products(basis, z));
}

namespace {

// Of all columns beside a basis, stretch by stretch: what the statistic and its null are made of.
struct ProjectedSums {
  ProjectedSums(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis,
                const Eigen::VectorXd& residual, const Clusters& clusters)
      : sums(static_cast<Eigen::Index>(clusters.stretches.size()), z.cols()),
        squares(sums.rows(), z.cols()),
        along(cross_products(basis, z)),
        before(z.colwise().squaredNorm()),
        after((before - along.colwise().squaredNorm().transpose()).cwiseMax(0)) {
    constexpr Eigen::Index kColumnsAtOnce = 16;  // are still in the cache when they are summed
    for (Eigen::Index first = 0; first < z.cols(); first += kColumnsAtOnce) {
      const Eigen::Index count = std::min(kColumnsAtOnce, z.cols() - first);
      const Eigen::MatrixXd off =
          less_combination(z.middleCols(first, count), basis, along.middleCols(first, count));
      for (Eigen::Index j = 0; j < count; ++j)
        add_column(off.col(j), residual, clusters, first + j);
    }
  }

  Eigen::MatrixXd sums;     // stretches x columns: residual' (z less the basis)
  Eigen::MatrixXd squares;  // the same: of z less the basis
  Eigen::MatrixXd along;    // basis' z
  Eigen::VectorXd before;   // a column's squares
  Eigen::VectorXd after;    // ... less the basis

 private:
  void add_column(const Eigen::Ref<const Eigen::VectorXd>& off, const Eigen::VectorXd& residual,
                  const Clusters& clusters, Eigen::Index column) {
    for (Eigen::Index c = 0; c < sums.rows(); ++c) {
      const RowRange& range = clusters.stretches[static_cast<std::size_t>(c)];
      const auto begin = static_cast<Eigen::Index>(range.begin);
      const auto size = static_cast<Eigen::Index>(range.size());
      sums(c, column) = residual.segment(begin, size).dot(off.segment(begin, size));
      squares(c, column) = off.segment(begin, size).squaredNorm();
    }
  }
};

// Of the columns of a block those of which something survives beside the basis.
std::vector<Eigen::Index> surviving(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                    Eigen::Index first, Eigen::Index count) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = first; j < first + count; ++j) {
    if (after[j] > kSmallestShare * before[j]) kept.push_back(j);
  }
  return kept;
}

BlockScores score_one(const Eigen::MatrixXd& z, const ProjectedSums& all, const Block& block) {
  BlockScores out;
  const auto first = static_cast<Eigen::Index>(block.first);
  const auto count = static_cast<Eigen::Index>(block.count);
  const double before = all.before.segment(first, count).sum();
  const double after = all.after.segment(first, count).sum();
  out.test.share = before > 0 ? std::sqrt(after / before) : 0;
  const std::vector<Eigen::Index> kept = surviving(all.before, all.after, first, count);
  if (kept.empty()) return out;
  out.test.testable = true;
  out.test.information = after / static_cast<double>(count);
  const Eigen::VectorXd scale = all.before(kept).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd columns = z(Eigen::all, kept);
  const Eigen::MatrixXd along = all.along(Eigen::all, kept);
  const Eigen::MatrixXd gram = gram_of(columns) - along.transpose() * along;
  count_clusters(out.test, all.squares(Eigen::all, kept) * scale.cwiseAbs2());
  finish_scores(out, scale.asDiagonal() * gram * scale.asDiagonal(),
                all.sums(Eigen::all, kept) * scale.asDiagonal(), 0);
  return out;
}

}  // namespace

std::vector<BlockScores> score_blocks(const Eigen::MatrixXd& z, std::span<const Block> blocks,
                                      const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual,
                                      const Clusters& clusters) {
  const ProjectedSums all(z, basis, residual, clusters);
  std::vector<BlockScores> scores;
  scores.reserve(blocks.size());
  for (const Block& block : blocks) scores.push_back(score_one(z, all, block));
  return scores;
}

BlockScores score_block(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis,
                        const Eigen::VectorXd& residual, const Clusters& clusters) {
  const Block whole{0, static_cast<std::size_t>(z.cols())};
  return score_blocks(z, std::span(&whole, 1), basis, residual, clusters).front();
}

double score_statistic(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis,
                       const Eigen::VectorXd& residual) {
  const Eigen::MatrixXd along = cross_products(basis, z);
  const Eigen::VectorXd before = z.colwise().squaredNorm();
  const Eigen::VectorXd after = before - along.colwise().squaredNorm().transpose();
  const std::vector<Eigen::Index> kept = surviving(before, after, 0, z.cols());
  if (kept.empty()) return 0;
  const Eigen::VectorXd scale = before(kept).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd gram =
      gram_of(z)(kept, kept) - along(Eigen::all, kept).transpose() * along(Eigen::all, kept);
  const Eigen::VectorXd sums = (z.transpose() * residual)(kept);
  return factor_of(scale.asDiagonal() * gram * scale.asDiagonal(), 0)
      .triangularView<Eigen::Lower>()
      .solve(scale.cwiseProduct(sums))
      .squaredNorm();
}

BlockScores score_block_evenly(const Eigen::MatrixXd& z, const Eigen::MatrixXd& basis,
                               const Eigen::VectorXd& residual, const Clusters& clusters) {
  const Eigen::MatrixXd off = project_off(z, basis);
  const double least =
      kHoldsLittle * off.squaredNorm() / static_cast<double>(clusters.stretches.size());
  Eigen::MatrixXd even = z;
  for (const RowRange& stretch : clusters.stretches) {
    const auto begin = static_cast<Eigen::Index>(stretch.begin);
    const auto size = static_cast<Eigen::Index>(stretch.size());
    even.middleRows(begin, size) /=
        std::sqrt(std::max(off.middleRows(begin, size).squaredNorm(), least));
  }
  return score_block(even, basis, residual, clusters);
}

BlockScores score_sums(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& sums, double ridge) {
  BlockScores out;
  out.test.testable = true;
  finish_scores(out, gram, sums, ridge);
  return out;
}

std::vector<double> flip_maxima(std::span<BlockScores> blocks, const Flips& flips,
                                double stop_above, std::size_t stop_count) {
  std::vector<double> maxima;
  maxima.reserve(flips.count());
  std::size_t exceeding = 0;
  LargestScore score(blocks);
  const FloatRows all = side_by_side(blocks);
  for (std::size_t first = 0; first < flips.count(); first += kFlipsAtOnce) {
    const FloatRows sums = flips.sums(all, first, std::min(kFlipsAtOnce, flips.count() - first));
    for (Eigen::Index b = 0; b < sums.rows(); ++b) {
      const double largest = score.of(sums.data() + b * sums.cols());
      maxima.push_back(largest);
      if (stop_count > 0 && largest >= stop_above) ++exceeding;
    }
    if (stop_count > 0 && exceeding >= stop_count) break;
  }
  return maxima;
}

double critical_score(std::vector<double> maxima, double alpha) {
  const double rank = alpha * (1.0 + static_cast<double>(maxima.size()));
  const auto at = static_cast<std::size_t>(std::max(0.0, rank - 1));
  if (at >= maxima.size()) return 0;
  std::ranges::nth_element(maxima, maxima.begin() + static_cast<std::ptrdiff_t>(at),
                           std::ranges::greater());
  return maxima[at];
}

double adjusted_p(double score, std::span<const double> maxima) {
  const auto at_least =
      std::ranges::count_if(maxima, [score](double largest) { return largest >= score; });
  return (1.0 + static_cast<double>(at_least)) / (1.0 + static_cast<double>(maxima.size()));
}

}  // namespace tribench::loop
