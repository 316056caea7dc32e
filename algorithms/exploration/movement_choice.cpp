// SPDX-License-Identifier: MIT
#include "algorithms/exploration/movement_choice.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kRivals = 10;  // verdicts, the most likely of those left
constexpr std::size_t kManyColumns = 20;
constexpr std::size_t kLargeRivals = 2;  // of so many columns: they take long
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
    const double precision = 1 / prior_variance(*block);
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

// What a misfit's column has of its block's columns, both by their places among a contrast's.
struct SharedShape {
  Eigen::Index misfit = 0;
  std::vector<Eigen::Index> own;
  Eigen::VectorXd share;

  // Leaves of the column what is the misfit's alone.
  void take_from(Eigen::MatrixXd& columns) const {
    columns.col(misfit) -= columns(Eigen::all, own) * share;
  }
};

// A block that one explanation has and the other lacks; the base and everything else that either
// has, misfits included, refitted.
struct Contrast {
  Columns columns;  // the rest, then the block
  std::vector<SharedShape> shared;
  Eigen::MatrixXd gram;  // with the base first, over the variance, priors included
  Eigen::VectorXd mean;  // of the block
  double if_there = 0;   // how likely the block is, of the two
  std::size_t rival = 0;
};

struct Rival {
  std::string verdict;
  double weight = 0;  // posterior
};

struct Rivals {
  std::vector<Rival> rivals;
  std::vector<Contrast> contrasts;
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
      if (found != block.column.end()) mean[found - block.column.begin()] = posterior.effects[k];
      ++k;
    }
  }
  return mean;
}

// After the base's.
std::vector<SharedShape> shared_by(std::span<const Explanation* const> both, const Columns& columns,
                                   Eigen::Index base) {
  const auto place_of = [&](Eigen::Index j) {
    const auto found = std::ranges::find(columns.column, j);
    return base + static_cast<Eigen::Index>(found - columns.column.begin());
  };
  std::vector<SharedShape> all;
  for (const Explanation* one : both) {
    for (const EffectBlock* block : one->blocks) {
      if (block->shared.size() == 0) continue;
      std::vector<Eigen::Index> own;
      for (const Eigen::Index j : block->columns) own.push_back(place_of(j));
      for (std::size_t k = 0; k < block->misfit.size(); ++k) {
        const Eigen::Index misfit = place_of(block->misfit[k]);
        if (std::ranges::count(all, misfit, &SharedShape::misfit) > 0) continue;
        all.push_back({misfit, own, block->shared.col(static_cast<Eigen::Index>(k))});
      }
    }
  }
  return all;
}

Contrast contrast_of(const Assessment& now, const Explanation& larger, const Explanation& smaller,
                     const Columns& block) {
  Contrast out;
  out.columns = without(columns_of(smaller), block);
  const std::array<const Explanation*, 2> both = {&larger, &smaller};
  for (const Explanation* one : both) {
    for (const EffectBlock* own : one->blocks) {
      for (const Eigen::Index j : own->misfit) out.columns.add(j, 1 / (own->size * own->size));
    }
  }
  for (std::size_t k = 0; k < block.size(); ++k) {
    out.columns.add(block.column[k], block.precision[k]);
  }
  const Eigen::Index base = now.sums.base_count();
  out.shared = shared_by(both, out.columns, base);
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
  }
  // The rows of a symmetric matrix as its columns.
  for (int side = 0; side < 2; ++side) {
    for (const SharedShape& one : out.shared) one.take_from(out.gram);
    out.gram.transposeInPlace();
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    // Coefficients of the base are free but for rounding.
    out.gram(i, i) +=
        i < base ? 1e-9 * (1 + out.gram(i, i))
                 : out.columns.precision[static_cast<std::size_t>(i - base)] / now.variance;
  }
  out.mean = mean_of(now, larger, block);
  return out;
}

// Of each verdict that is not the likeliest explanation's, the likeliest explanation. The disputed
// one weighs as much as ours.
Rivals rivals_of(const Assessment& now, const std::string& disputed) {
  const Explanation& best = now.best();
  const double leader = now.weight_of(best.verdict);
  const Columns ours = columns_of(best);
  Rivals all;
  std::set<std::string> seen = {best.verdict};
  std::size_t large = 0;
  for (const Explanation& rival : now.explanations) {
    const bool is_disputed = rival.verdict == disputed;
    if (seen.size() > kRivals && !is_disputed) continue;
    if (!seen.insert(rival.verdict).second) continue;
    const Columns theirs = columns_of(rival);
    const Columns more = without(theirs, ours);
    const Columns fewer = without(ours, theirs);
    if (more.size() + fewer.size() == 0) continue;
    if (std::max(more.size(), fewer.size()) > kManyColumns && ++large > kLargeRivals) continue;
    const double weight = is_disputed ? leader : now.weight_of(rival.verdict);
    const double ours_is = leader / (leader + weight);
    const auto add = [&](const Explanation& larger, const Explanation& smaller,
                         const Columns& block, double likely) {
      if (block.size() == 0) return;
      all.contrasts.push_back(contrast_of(now, larger, smaller, block));
      all.contrasts.back().rival = all.rivals.size();
      all.contrasts.back().if_there = likely;
    };
    add(rival, best, more, 1 - ours_is);
    add(best, rival, fewer, ours_is);
    all.rivals.push_back({rival.verdict, weight});
  }
  return all;
}

// The share of a movement's mean that its offset hides, as whitening takes it away.
double hidden_share(const Noise& noise, double rows) {
  const double ratio = noise.between_sd / noise.within_sd;
  const double effective = rows / noise.inflation() * ratio * ratio;
  return effective / (1 + effective);
}

// What whitened rows like these would add to the products, each as often as it counts.
void add_rows(Eigen::MatrixXd& gram, const Eigen::MatrixXd& rows, double counts, const Noise& noise,
              double variance) {
  // The share of a column's square that is left of it once rows are whitened, where it changes
  // slowly.
  const double left = noise.unit() / (2 * noise.within_sd * noise.within_sd * noise.inflation());
  const double shrink = counts * left / variance;
  const auto count = static_cast<double>(rows.rows());
  auto lower = gram.selfadjointView<Eigen::Lower>();
  lower.rankUpdate(rows.transpose(), shrink);
  const Eigen::VectorXd mean = rows.colwise().mean();
  lower.rankUpdate(mean, -shrink * count * hidden_share(noise, counts * count));
}

// Of every movement, nats: what it shows were the block there, what fades were it not (as the
// block's prior has nothing near zero), by how likely either is.
std::vector<double> gains_of(const Contrast& contrast, const Assessment& now,
                             const Foreseen& foreseen) {
  const BlockInformation before = information(contrast.gram, contrast.mean);
  const auto p = static_cast<double>(contrast.mean.size());
  Eigen::MatrixXd rows(foreseen.base.rows(), contrast.gram.cols());
  rows << foreseen.base, foreseen.columns(Eigen::all, contrast.columns.column);
  for (const SharedShape& one : contrast.shared) one.take_from(rows);
  std::vector<double> gains;
  for (const MovementRows& movement : foreseen.movements) {
    gains.push_back(0);
    const RowRange& range = movement.rows;
    if (range.size() == 0) continue;
    Eigen::MatrixXd gram = contrast.gram;
    add_rows(gram,
             rows.middleRows(static_cast<Eigen::Index>(range.begin),
                             static_cast<Eigen::Index>(range.size())),
             movement.counts, now.noise, now.variance);
    const BlockInformation after = information(gram, contrast.mean);
    const double shows = 0.5 * (after.squares - before.squares);
    const double fades = (0.5 + static_cast<double>(kMomentOrder) / p) *
                         (after.log_determinant - before.log_determinant);
    const double gain = contrast.if_there * shows + (1 - contrast.if_there) * fades;
    if (std::isfinite(gain) && gain > 0) gains.back() = gain;
  }
  return gains;
}

}  // namespace

std::vector<MovementChoice> movement_gains(const Assessment& now, const Foreseen& foreseen,
                                           const std::string& disputed) {
  const Rivals all = rivals_of(now, disputed);
  const std::size_t movements = foreseen.movements.size();
  std::vector<std::vector<double>> gains(all.rivals.size(), std::vector<double>(movements, 0.0));
  for (const Contrast& contrast : all.contrasts) {
    const std::vector<double> own = gains_of(contrast, now, foreseen);
    for (std::size_t m = 0; m < movements; ++m) gains[contrast.rival][m] += own[m];
  }
  std::vector<MovementChoice> choices;
  for (std::size_t m = 0; m < movements; ++m) {
    double before = 0;
    double after = 0;
    double most = 0;
    std::size_t told = 0;
    for (std::size_t r = 0; r < all.rivals.size(); ++r) {
      const double left = all.rivals[r].weight * elementary::exp(-gains[r][m]);
      before += all.rivals[r].weight;
      after += left;
      if (all.rivals[r].weight - left <= most) continue;
      most = all.rivals[r].weight - left;
      told = r;
    }
    if (!(before > 0 && after > 0)) continue;
    const double gain = elementary::log(before / after);
    if (gain < kLeastGain) continue;
    choices.push_back({m, gain, now.best().verdict + " | " + all.rivals[told].verdict});
  }
  return choices;
}

}  // namespace tribench::loop
