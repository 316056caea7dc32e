// SPDX-License-Identifier: MIT
#include "algorithms/exploration/assessment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/inference/whitening.hpp"
#include "algorithms/loop_model/model_fit.hpp"
#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench::loop {
namespace {

// Of a movement, in the noise's: what lives in time alone takes offsets for its own, and where it
// has taken them nothing is left that would say so.
constexpr double kLeastOffset = 0.15;

// Changes of the noise that are worth summing up all rows again.
constexpr double kOtherCorrelation = 0.04;
constexpr double kOtherRatio = 1.2;
constexpr double kOtherCut = 1;  // of a row, in the noise's

// Of a row, in what most rows have: what is beyond it says that something is wrong with the row (a
// sensor that was late, a velocity of the wrong sign at standstill), and no more than that.
constexpr double kBelieved = 4;

// Posterior and e-values; the most likely first.
void weigh(std::vector<Explanation>& all) {
  std::vector<double> logs;
  for (const Explanation& one : all) logs.push_back(one.log_prior + one.log_evidence);
  const double total = log_sum(logs);
  for (Explanation& one : all) {
    one.weight = elementary::exp(one.log_prior + one.log_evidence - total);
    one.log_e_value = total - one.log_evidence;
  }
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.weight > b.weight; });
}

// Of an explanation's columns in one matrix of all columns.
Eigen::MatrixXd own_columns(const Explanation& one, const Eigen::MatrixXd& columns) {
  ColumnBlock all;
  for (const EffectBlock* block : one.blocks) {
    all.insert(all.end(), block->columns.begin(), block->columns.end());
  }
  for (const EffectBlock* block : one.blocks) {
    all.insert(all.end(), block->misfit.begin(), block->misfit.end());
  }
  return columns(Eigen::all, all);
}

Clusters clusters_of(std::span<const std::size_t> sizes) {
  std::vector<int> movement;
  for (std::size_t m = 0; m < sizes.size(); ++m) {
    movement.insert(movement.end(), sizes[m], static_cast<int>(m));
  }
  return make_clusters(movement, 1);
}

// What of each row is beyond what is believed of it (winsorised residuals, Huber 1981).
Eigen::VectorXd beyond_belief(const Eigen::VectorXd& rest) {
  const double usual = kMadToSd * upper_median_magnitude({rest.begin(), rest.end()});
  if (!(usual > 0)) return Eigen::VectorXd::Zero(rest.size());
  const double limit = kBelieved * usual;
  return rest - rest.cwiseMin(limit).cwiseMax(-limit);
}

bool alike(double a, double b) { return a <= kOtherRatio * b && b <= kOtherRatio * a; }

}  // namespace

double Assessment::weight_of(const std::string& verdict) const {
  double sum = 0;
  for (const Explanation& one : explanations) sum += one.verdict == verdict ? one.weight : 0;
  return sum;
}

void Assessor::add(const Observations& rows) {
  if (rows.rows() == 0) return;
  const Eigen::MatrixXd base = space_.base_columns(rows);
  const Eigen::MatrixXd columns = space_.columns(rows);
  const Eigen::VectorXd target = target_vector(rows);
  for (const RowRange& range : make_clusters(rows.movement, 1).movements) {
    const auto first = static_cast<Eigen::Index>(range.begin);
    const auto count = static_cast<Eigen::Index>(range.size());
    seen_.push_back({base.middleRows(first, count), columns.middleRows(first, count),
                     target.segment(first, count)});
  }
}

Assessor::Leftover Assessor::left_by(const Explanation& one) const {
  std::vector<std::size_t> sizes;
  std::size_t rows = 0;
  for (const SeenMovement& movement : seen_) {
    sizes.push_back(static_cast<std::size_t>(movement.base.rows()));
    rows += sizes.back();
  }
  const Eigen::Index base_count = seen_.front().base.cols();
  Eigen::Index own_count = 0;
  for (const EffectBlock* block : one.blocks) {
    own_count += static_cast<Eigen::Index>(block->columns.size() + block->misfit.size());
  }
  Eigen::MatrixXd base(static_cast<Eigen::Index>(rows), base_count);
  Eigen::MatrixXd own(static_cast<Eigen::Index>(rows), own_count);
  Eigen::VectorXd rest(static_cast<Eigen::Index>(rows));
  Eigen::Index next = 0;
  for (const SeenMovement& movement : seen_) {
    const Eigen::Index count = movement.base.rows();
    base.middleRows(next, count) = movement.base;
    if (own_count > 0) own.middleRows(next, count) = own_columns(one, movement.columns);
    rest.segment(next, count) = movement.target;
    next += count;
  }
  const double squares = rest.squaredNorm();
  if (!one.blocks.empty()) {
    // The same blocks by their places in `own`.
    std::vector<EffectBlock> blocks;
    std::vector<const EffectBlock*> pointers;
    Eigen::Index column = 0;
    const auto renumbered = [&](std::size_t count) {
      ColumnBlock block;
      while (block.size() < count) block.push_back(column++);
      return block;
    };
    for (const EffectBlock* block : one.blocks) {
      blocks.push_back(*block);
      blocks.back().columns = renumbered(block->columns.size());
    }
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      blocks[k].misfit = renumbered(one.blocks[k]->misfit.size());
      pointers.push_back(&blocks[k]);
    }
    EvidenceSums sums;
    sums.add(base, own, rest);
    rest -= own * EvidenceTable(sums).posterior(pointers).mean;
  }
  rest -= base * least_squares(base, rest);
  const Eigen::VectorXd cut = beyond_belief(rest);
  rest -= cut;
  Leftover left;
  Clusters clusters = clusters_of(sizes);
  for (const RowRange& range : clusters.movements) {
    left.cuts.emplace_back(cut.segment(static_cast<Eigen::Index>(range.begin),
                                       static_cast<Eigen::Index>(range.size())));
  }
  left.weights = movement_weights(rest, clusters);
  clusters.weight = left.weights;
  const double floor = 1e-9 * std::sqrt(squares / static_cast<double>(rows));
  left.noise =
      estimate_noise(rest, clusters, static_cast<std::size_t>(base_count + own_count), floor);
  left.noise.whitened = true;
  left.noise.between_sd = std::max(left.noise.between_sd, kLeastOffset * left.noise.within_sd);
  return left;
}

bool Assessor::is_as_it_was(const Leftover& left) const {
  const Noise& noise = left.noise;
  if (last_.sums.rows() == 0) return false;
  const Noise& before = last_.noise;
  if (std::abs(noise.rho() - before.rho()) > kOtherCorrelation) return false;
  if (!alike(noise.inflation(), before.inflation())) return false;
  // As they shrink a movement's offset.
  const auto offsets = [](const Noise& one) {
    return 1 + one.between_sd * one.between_sd / (one.within_sd * one.within_sd);
  };
  if (!alike(offsets(noise), offsets(before))) return false;
  for (std::size_t m = 0; m < seen_.size(); ++m) {
    if (seen_[m].weight == 0) continue;
    if (!alike(seen_[m].weight, left.weights[m])) return false;
    const double other_cut = (seen_[m].cut - left.cuts[m]).cwiseAbs().maxCoeff();
    if (other_cut > kOtherCut * noise.within_sd) return false;
  }
  return true;
}

void Assessor::add_to(EvidenceSums& sums, const SeenMovement& movement, double weight,
                      const Eigen::VectorXd& cut) const {
  const std::array<std::size_t, 1> size = {static_cast<std::size_t>(movement.base.rows())};
  Clusters clusters = clusters_of(size);
  clusters.weight = {weight};
  sums.add(whitened(movement.base, clusters, last_.noise),
           whitened(movement.columns, clusters, last_.noise),
           whitened(movement.target - cut, clusters, last_.noise));
}

// Movements that no look has seen yet, with what was known before them. How loud each of them is
// nobody could foresee, and all explanations are told alike.
void Assessor::hold_forecasts_against_rows(const Leftover& left) {
  const auto is_new = [](const SeenMovement& one) { return one.weight == 0; };
  if (last_.explanations.empty() || std::ranges::none_of(seen_, is_new)) return;
  EvidenceSums further = last_.sums;
  for (std::size_t m = 0; m < seen_.size(); ++m) {
    if (is_new(seen_[m])) add_to(further, seen_[m], left.weights[m], left.cuts[m]);
  }
  forecasts_.add(last_.explanations, last_.table, EvidenceTable(further));
}

const Assessment& Assessor::look() {
  const Explanation before = last_.explanations.empty() ? Explanation() : Explanation(last_.best());
  const Leftover left = left_by(before);
  hold_forecasts_against_rows(left);
  if (!is_as_it_was(left)) {
    // What was said under another noise says nothing: the rows so far are the opening.
    forecasts_ = {};
    last_.noise = left.noise;
    last_.sums = {};
    for (SeenMovement& movement : seen_) movement.weight = 0;
  }
  for (std::size_t m = 0; m < seen_.size(); ++m) {
    if (seen_[m].weight > 0) continue;
    seen_[m].weight = left.weights[m];
    seen_[m].cut = left.cuts[m];
    add_to(last_.sums, seen_[m], left.weights[m], left.cuts[m]);
  }
  last_.table = EvidenceTable(last_.sums);
  FoundExplanations found = find_explanations(space_, last_.table);
  weigh(found.explanations);
  last_.explanations = std::move(found.explanations);
  last_.blocks = std::move(found.blocks);
  forecasts_.hear(last_.explanations);
  last_.forecast = forecasts_.verdicts();
  last_.variance = last_.table.posterior(last_.best().blocks).variance;
  const double limit = -elementary::log(alpha_);
  last_.alive.clear();
  for (std::size_t i = 0; i < last_.explanations.size(); ++i) {
    if (last_.explanations[i].log_e_value < limit) last_.alive.push_back(i);
  }
  return last_;
}

}  // namespace tribench::loop
