// SPDX-License-Identifier: MIT
#include "algorithms/inference/within_movements.hpp"

#include <numeric>
#include <utility>
#include <vector>

#include "algorithms/inference/score_test.hpp"

namespace tribench::loop {
namespace {

constexpr double kLeastWithin = 1e-3;  // of the sum of squares, as in score_test.hpp

double p_of_scores(const AskedColumn& asked, const Clusters& clusters, const Flips& flips) {
  const Eigen::MatrixXd basis = orthonormal_basis(asked.model);
  std::vector<BlockScores> scores = {
      score_block(asked.column, basis, project_off(asked.residual, basis), clusters)};
  if (!scores.front().test.testable) return 1;
  return adjusted_p(scores.front().test.score, flip_maxima(scores, flips));
}

// Every movement a cluster.
Clusters whole_movements(Clusters clusters) {
  clusters.stretches = clusters.movements;
  clusters.movement_of.resize(clusters.movements.size());
  std::iota(clusters.movement_of.begin(), clusters.movement_of.end(), std::size_t{0});
  clusters.fold_of.clear();  // no test reads it
  return clusters;
}

}  // namespace

Eigen::MatrixXd within_movements(Eigen::MatrixXd columns, const Eigen::MatrixXd& terms,
                                 std::span<const RowRange> movements) {
  for (const RowRange& movement : movements) {
    const auto begin = static_cast<Eigen::Index>(movement.begin);
    const auto size = static_cast<Eigen::Index>(movement.size());
    auto rows = columns.middleRows(begin, size);
    rows = project_off(rows, orthonormal_basis(terms.middleRows(begin, size)));
  }
  return columns;
}

double p_within_movements(const AskedColumn& asked, const Eigen::MatrixXd& terms,
                          const Clusters& clusters, const Flips& flips) {
  const auto within = [&](const Eigen::MatrixXd& columns) {
    return within_movements(columns, terms, clusters.movements);
  };
  const AskedColumn inner = {within(asked.column), within(asked.model), within(asked.residual)};
  const double least = kLeastWithin * asked.column.squaredNorm();
  return inner.column.squaredNorm() > least ? p_of_scores(inner, clusters, flips) : 1;
}

double p_of_movements(const AskedColumn& asked, const Clusters& clusters, std::size_t flips,
                      RandomStream random) {
  return p_of_scores(asked, whole_movements(clusters),
                     Flips(flips, clusters.movements.size(), std::move(random)));
}

}  // namespace tribench::loop
