// SPDX-License-Identifier: MIT
#include "algorithms/exploration/movement_choice.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kRivals = 24;  // the most likely of those left
constexpr std::size_t kManyColumns = 20;
constexpr std::size_t kLargeRivals = 4;  // of so many columns: they take long
constexpr double kEnough = 1;            // nats: beyond what is needed gains count no more
constexpr double kLeastGain = 1e-3;

using Columns = std::vector<Eigen::Index>;

Columns columns_of(const Explanation& one) {
  Columns all;
  for (const ColumnBlock* block : one.blocks) all.insert(all.end(), block->begin(), block->end());
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

Columns without(const Columns& all, const Columns& taken) {
  Columns rest;
  std::ranges::set_difference(all, taken, std::back_inserter(rest));
  return rest;
}

Eigen::MatrixXd part_of(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                        const Columns& rest, const Columns& block) {
  Eigen::MatrixXd out(base.rows(),
                      base.cols() + static_cast<Eigen::Index>(rest.size() + block.size()));
  out.leftCols(base.cols()) = base;
  Eigen::Index next = base.cols();
  for (const Eigen::Index j : rest) out.col(next++) = columns.col(j);
  for (const Eigen::Index j : block) out.col(next++) = columns.col(j);
  return out;
}

// A block that one explanation has and the other lacks, everything else refitted.
struct Contrast {
  Eigen::MatrixXd gram;  // of base, the rest and the block, over the variance, priors included
  Eigen::Index first = 0;
  Eigen::VectorXd mean;        // of the block, over the noise
  Eigen::MatrixXd candidates;  // rows of all candidates
  double needed = 0;           // nats
  double share = 1;
  std::string rival;

  Eigen::MatrixXd information(const Eigen::MatrixXd& all) const {
    const Eigen::Index p = all.rows() - first;
    const Eigen::LLT<Eigen::MatrixXd> rest(all.topLeftCorner(first, first));
    const Eigen::MatrixXd across = all.topRightCorner(first, p);
    return all.bottomRightCorner(p, p) - across.transpose() * rest.solve(across);
  }
};

double log_determinant(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  double sum = 0;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    sum += 2 * elementary::log(Eigen::MatrixXd(factor.matrixL())(i, i));
  }
  return sum;
}

Contrast contrast_of(const Assessment& now, const Explanation& larger, const Columns& rest,
                     const Columns& block) {
  Contrast out;
  const Eigen::MatrixXd seen = part_of(now.base, now.columns, rest, block);
  out.gram = seen.transpose() * seen / now.variance;
  out.first = now.base.cols() + static_cast<Eigen::Index>(rest.size());
  for (Eigen::Index i = 0; i < out.gram.rows(); ++i) {
    // Coefficients of the base are free but for rounding; the others have their prior.
    out.gram(i, i) += i < now.base.cols() ? 1e-9 * (1 + out.gram(i, i))
                                          : static_cast<double>(block.size()) / now.variance;
  }
  const EvidenceTable::Posterior posterior = now.table.posterior(larger.blocks);
  out.mean.setZero(static_cast<Eigen::Index>(block.size()));
  Eigen::Index k = 0;
  for (const ColumnBlock* one : larger.blocks) {
    for (const Eigen::Index j : *one) {
      const auto found = std::ranges::find(block, j);
      if (found != block.end()) out.mean[found - block.begin()] = posterior.mean[k];
      ++k;
    }
  }
  out.candidates = part_of(now.foreseen_base, now.foreseen_columns, rest, block);
  return out;
}

std::vector<Contrast> contrasts_of(const Assessment& now, double alpha) {
  const Explanation& best = now.best();
  const Columns ours = columns_of(best);
  const double limit = -elementary::log(alpha);
  std::vector<Contrast> all;
  std::size_t large = 0;
  for (const Explanation& rival : now.explanations) {
    if (rival.verdict == best.verdict) continue;
    if (all.size() >= kRivals) break;
    const Columns theirs = columns_of(rival);
    const Columns more = without(theirs, ours);
    const Columns fewer = without(ours, theirs);
    if (std::max(more.size(), fewer.size()) > kManyColumns && ++large > kLargeRivals) continue;
    const double needed = std::max(limit - rival.log_e_value, 0.0) + kEnough;
    const auto add = [&](const Explanation& larger, const Columns& rest, const Columns& block) {
      if (block.empty()) return;
      all.push_back(contrast_of(now, larger, rest, block));
      all.back().needed = needed;
      all.back().rival = rival.verdict;
      all.back().share = more.empty() || fewer.empty() ? 1 : 0.5;
    };
    add(rival, ours, more);
    add(best, theirs, fewer);
  }
  return all;
}

}  // namespace

std::vector<MovementChoice> rank_movements(const Assessment& now, double alpha,
                                           std::span<const MovementRows> movements) {
  std::vector<MovementChoice> choices(movements.size());
  std::vector<double> best_part(movements.size(), 0.0);
  for (std::size_t m = 0; m < movements.size(); ++m) choices[m].movement = m;
  for (const Contrast& contrast : contrasts_of(now, alpha)) {
    const Eigen::MatrixXd before = contrast.information(contrast.gram);
    const auto p = static_cast<double>(contrast.mean.size());
    const double before_log = log_determinant(before);
    const double shrink = (1 - now.noise.whitening) * (1 - now.noise.whitening);
    for (std::size_t m = 0; m < movements.size(); ++m) {
      const RowRange& range = movements[m].rows;
      const auto rows = contrast.candidates.middleRows(static_cast<Eigen::Index>(range.begin),
                                                       static_cast<Eigen::Index>(range.size()));
      const Eigen::MatrixXd after = contrast.information(
          contrast.gram + movements[m].counts * shrink / now.variance * rows.transpose() * rows);
      const double shows = 0.5 * contrast.mean.dot((after - before) * contrast.mean);
      const double fades = (0.5 + 1 / p) * (log_determinant(after) - before_log);
      const double gain = std::min(contrast.share * (shows + fades), contrast.needed);
      if (!std::isfinite(gain) || gain <= 0) continue;
      choices[m].gain += gain;
      if (gain > best_part[m]) {
        best_part[m] = gain;
        choices[m].between = now.best().verdict + " | " + contrast.rival;
      }
    }
  }
  for (MovementChoice& one : choices) one.per_second = one.gain / movements[one.movement].cost_s;
  std::erase_if(choices, [](const MovementChoice& one) { return one.gain < kLeastGain; });
  std::ranges::stable_sort(
      choices, [](const auto& a, const auto& b) { return a.per_second > b.per_second; });
  return choices;
}

}  // namespace tribench::loop
