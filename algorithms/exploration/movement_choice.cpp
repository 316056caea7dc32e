// SPDX-License-Identifier: MIT
#include "algorithms/exploration/movement_choice.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kRivals = 10;  // verdicts, the most likely of those left
constexpr std::size_t kManyColumns = 20;
constexpr std::size_t kLargeRivals = 2;  // of so many columns: they take long
constexpr double kEnough = 1;            // nats: beyond what is needed gains count no more
constexpr double kLeastGain = 1e-3;

// Columns with the precision of their prior, in the noise's.
struct Columns {
  std::vector<Eigen::Index> column;
  std::vector<double> precision;

  std::size_t size() const { return column.size(); }
  bool has(Eigen::Index j) const { return std::ranges::count(column, j) > 0; }
  void add(Eigen::Index j, double own) {
    if (has(j)) return;
    column.push_back(j);
    precision.push_back(own);
  }
};

Columns columns_of(const Explanation& one) {
  Columns all;
  for (const EffectBlock* block : one.blocks) {
    const double precision =
        static_cast<double>(block->columns.size()) / (block->size * block->size);
    for (const Eigen::Index j : block->columns) all.add(j, precision);
  }
  return all;
}

Columns without(const Columns& all, const Columns& taken) {
  Columns rest;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!taken.has(all.column[k])) rest.add(all.column[k], all.precision[k]);
  }
  return rest;
}

// A block that one explanation has and the other lacks; the base and everything else that either
// has, misfits included, refitted.
struct Contrast {
  Columns columns;       // the rest, then the block
  Eigen::MatrixXd gram;  // with the base first, over the variance, priors included
  Eigen::VectorXd mean;  // of the block
  double needed = 0;     // nats
  double share = 1;
  std::string rival;
};

// What rows with this Gram matrix say of its last columns, all others refitted.
struct BlockInformation {
  double squares = 0;  // of the block's mean
  double log_determinant = 0;
};
BlockInformation information(const Eigen::MatrixXd& gram, const Eigen::VectorXd& mean) {
  const Eigen::LLT<Eigen::MatrixXd> factor(gram);
  const Eigen::MatrixXd own = factor.matrixLLT().bottomRightCorner(mean.size(), mean.size());
  BlockInformation out;
  out.squares = (own.triangularView<Eigen::Lower>().transpose() * mean).squaredNorm();
  double determinant = 1;
  for (Eigen::Index i = 0; i < own.rows(); ++i) {
    determinant *= own(i, i);
    if (determinant > 1e100 || i + 1 == own.rows()) {
      out.log_determinant += 2 * elementary::log(determinant);
      determinant = 1;
    }
  }
  return out;
}

Eigen::VectorXd mean_of(const Assessment& now, const Explanation& one, const Columns& block) {
  const EvidenceTable::Posterior posterior = now.table.posterior(one.blocks);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(block.size()));
  Eigen::Index k = 0;
  for (const EffectBlock* own : one.blocks) {
    for (const Eigen::Index j : own->columns) {
      const auto found = std::ranges::find(block.column, j);
      if (found != block.column.end()) mean[found - block.column.begin()] = posterior.mean[k];
      ++k;
    }
  }
  return mean;
}

Contrast contrast_of(const Assessment& now, const Explanation& larger, const Explanation& smaller,
                     const Columns& block) {
  Contrast out;
  out.columns = without(columns_of(smaller), block);
  for (const Explanation* one : {&larger, &smaller}) {
    for (const EffectBlock* own : one->blocks) {
      for (const Eigen::Index j : own->misfit) out.columns.add(j, 1 / (own->size * own->size));
    }
  }
  for (std::size_t k = 0; k < block.size(); ++k) {
    out.columns.add(block.column[k], block.precision[k]);
  }
  const Eigen::Index base = now.sums.base_count();
  std::vector<Eigen::Index> places;
  for (Eigen::Index j = 0; j < base; ++j) places.push_back(j);
  for (const Eigen::Index j : out.columns.column) places.push_back(base + j);
  const auto size = static_cast<Eigen::Index>(places.size());
  out.gram.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const auto [low, high] =
          std::minmax(places[static_cast<std::size_t>(i)], places[static_cast<std::size_t>(j)]);
      out.gram(i, j) = now.sums.products()(high, low) / now.variance;
    }
    // Coefficients of the base are free but for rounding.
    out.gram(i, i) +=
        i < base ? 1e-9 * (1 + out.gram(i, i))
                 : out.columns.precision[static_cast<std::size_t>(i - base)] / now.variance;
  }
  out.mean = mean_of(now, larger, block);
  return out;
}

std::vector<Contrast> contrasts_of(const Assessment& now, double alpha) {
  const Explanation& best = now.best();
  const Columns ours = columns_of(best);
  const double limit = -elementary::log(alpha);
  std::vector<Contrast> all;
  std::set<std::string> seen = {best.verdict};
  std::size_t large = 0;
  for (const Explanation& rival : now.explanations) {
    if (seen.size() > kRivals) break;
    if (!seen.insert(rival.verdict).second) continue;
    const Columns theirs = columns_of(rival);
    const Columns more = without(theirs, ours);
    const Columns fewer = without(ours, theirs);
    if (std::max(more.size(), fewer.size()) > kManyColumns && ++large > kLargeRivals) continue;
    const double needed = std::max(limit - rival.log_e_value, 0.0) + kEnough;
    const auto add = [&](const Explanation& larger, const Explanation& smaller,
                         const Columns& block) {
      if (block.size() == 0) return;
      all.push_back(contrast_of(now, larger, smaller, block));
      all.back().needed = needed;
      all.back().rival = rival.verdict;
      all.back().share = more.size() == 0 || fewer.size() == 0 ? 1 : 0.5;
    };
    add(rival, best, more);
    add(best, rival, fewer);
  }
  return all;
}

// The share of a movement's mean that its offset hides, as whitening takes it away.
double hidden_share(const Noise& noise, double rows) {
  const double ratio = noise.between_sd / noise.within_sd;
  const double effective = rows * (1 - noise.rho) / (1 + noise.rho) * ratio * ratio;
  return effective / (1 + effective);
}

// What whitened rows like these would add to the products, each as often as it counts.
void add_rows(Eigen::MatrixXd& gram, const Eigen::MatrixXd& rows, double counts, const Noise& noise,
              double variance) {
  const double shrink = counts * (1 - noise.whitening) * (1 - noise.whitening) / variance;
  const auto count = static_cast<double>(rows.rows());
  auto lower = gram.selfadjointView<Eigen::Lower>();
  lower.rankUpdate(rows.transpose(), shrink);
  const Eigen::VectorXd mean = rows.colwise().mean();
  lower.rankUpdate(mean, -shrink * count * hidden_share(noise, counts * count));
}

}  // namespace

std::vector<MovementChoice> movement_gains(const Assessment& now, const Foreseen& foreseen,
                                           double alpha) {
  const std::vector<MovementRows>& movements = foreseen.movements;
  std::vector<MovementChoice> choices(movements.size());
  std::vector<double> best_part(movements.size(), 0.0);
  for (std::size_t m = 0; m < movements.size(); ++m) choices[m].movement = m;
  for (const Contrast& contrast : contrasts_of(now, alpha)) {
    const BlockInformation before = information(contrast.gram, contrast.mean);
    const auto p = static_cast<double>(contrast.mean.size());
    Eigen::MatrixXd rows(foreseen.base.rows(), contrast.gram.cols());
    rows << foreseen.base, foreseen.columns(Eigen::all, contrast.columns.column);
    for (std::size_t m = 0; m < movements.size(); ++m) {
      const RowRange& range = movements[m].rows;
      if (range.size() == 0) continue;
      const auto own = rows.middleRows(static_cast<Eigen::Index>(range.begin),
                                       static_cast<Eigen::Index>(range.size()));
      Eigen::MatrixXd gram = contrast.gram;
      add_rows(gram, own, movements[m].counts, now.noise, now.variance);
      const BlockInformation after = information(gram, contrast.mean);
      const double shows = 0.5 * (after.squares - before.squares);
      const double fades = (0.5 + 1 / p) * (after.log_determinant - before.log_determinant);
      const double gain = std::min(contrast.share * (shows + fades), contrast.needed);
      if (!std::isfinite(gain) || gain <= 0) continue;
      choices[m].gain += gain;
      if (gain > best_part[m]) {
        best_part[m] = gain;
        choices[m].between = now.best().verdict + " | " + contrast.rival;
      }
    }
  }
  std::erase_if(choices, [](const MovementChoice& one) { return one.gain < kLeastGain; });
  return choices;
}

}  // namespace tribench::loop
