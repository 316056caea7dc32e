// SPDX-License-Identifier: MIT
#include "algorithms/inference/feature_scores.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algorithms/expression/vector/each_level.hpp"
#include "algorithms/inference/float_lanes.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kRowsAtOnce = 64;
constexpr std::size_t kLeftAtOnce = 4;
// What a memory has left so little of counts no more.
constexpr float kFaded = 1e-20F;

std::size_t padded(std::size_t n, std::size_t to) { return (n + to - 1) / to * to; }

// A macro: a function could not take lanes that some instruction sets pass differently.
#define TRIBENCH_ADD_TO(target, lanes)         \
  do {                                         \
    Lanes sum_;                                \
    std::memcpy(&sum_, (target), sizeof sum_); \
    sum_ += (lanes);                           \
    std::memcpy((target), &sum_, sizeof sum_); \
  } while (false)

// out += left' right. Widths are multiples of kLeftAtOnce and kLanes; out has the right's. Where
// `lower` is set, blocks above the diagonal are left as they are.
TRIBENCH_EACH_LEVEL void add_product(const float* left, std::size_t left_width, const float* right,
                                     std::size_t right_width, std::size_t rows, bool lower,
                                     float* out) {
  for (std::size_t a = 0; a < left_width; a += kLeftAtOnce) {
    for (std::size_t b = 0; b < right_width; b += kLanes) {
      if (lower && b >= a + kLeftAtOnce) break;
      Lanes sum0 = {};
      Lanes sum1 = {};
      Lanes sum2 = {};
      Lanes sum3 = {};
      for (std::size_t i = 0; i < rows; ++i) {
        const float* l = left + i * left_width + a;
        Lanes r;
        std::memcpy(&r, right + i * right_width + b, sizeof r);
        sum0 += l[0] * r;
        sum1 += l[1] * r;
        sum2 += l[2] * r;
        sum3 += l[3] * r;
      }
      float* to = out + a * right_width + b;
      TRIBENCH_ADD_TO(to, sum0);
      TRIBENCH_ADD_TO(to + right_width, sum1);
      TRIBENCH_ADD_TO(to + 2 * right_width, sum2);
      TRIBENCH_ADD_TO(to + 3 * right_width, sum3);
    }
  }
}

}  // namespace

// Of one basis. Columns: the forward half, zeros up to a multiple of kLanes, the backward half.
struct FeatureScorer::Sums {
  Sums(std::size_t features, std::size_t halves, Eigen::Index left_width, std::size_t stretches)
      : count(features),
        width(padded(features, kLanes)),
        difference(kRowsAtOnce * width, 0.0F),
        products(FloatRows::Zero(left_width, static_cast<Eigen::Index>(width))),
        missed(halves * width, 0.0F),
        model(FloatRows::Zero(left_width, static_cast<Eigen::Index>(halves * width))),
        scores(FloatRows::Zero(static_cast<Eigen::Index>(stretches),
                               static_cast<Eigen::Index>(halves * width))),
        rest(FloatRows::Zero(scores.cols(), scores.cols())) {
    for (std::size_t h = 0; h < halves; ++h) {
      gram.push_back(
          FloatRows::Zero(static_cast<Eigen::Index>(width), static_cast<Eigen::Index>(width)));
    }
    offset.setZero(scores.cols());
  }

  std::size_t count;
  std::size_t width;
  std::vector<float> difference;  // scratch: whitened rows of a run, but for the offset
  FloatRows products;             // scratch: left' difference
  // Scratch: what the last row's forecast missed, both halves.
  std::vector<float> missed;
  FloatRows model;              // left' features; the last rows are not used
  FloatRows scores;             // per stretch
  std::vector<FloatRows> gram;  // of either half, lower blocks
  FloatRows rest;               // of the Gram matrix, both halves
  Eigen::RowVectorXf offset;    // of the present movement: the offset's direction' features
};

FeatureScorer::FeatureScorer(const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual,
                             const Clusters& clusters, const Noise& noise,
                             const Eigen::VectorXf& direction)
    : clusters_(clusters),
      filter_(Whitening(clusters, noise).filter()),
      direction_(direction),
      basis_columns_(basis.cols()) {
  const auto rows = static_cast<Eigen::Index>(clusters.rows);
  const auto width = padded(static_cast<std::size_t>(basis_columns_) + 2, kLeftAtOnce);
  left_ = FloatRows::Zero(rows, static_cast<Eigen::Index>(width));
  left_.leftCols(basis_columns_) = basis.cast<float>();
  left_.col(basis_columns_ + 1) = residual.cast<float>();
  const Whitening whitening(clusters, noise);
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) add_movement_of(m, whitening);
  const auto count = static_cast<Eigen::Index>(clusters.stretches.size());
  along_offset_.resize(count, left_.cols());
  along_residual_.resize(count, basis_columns_);
  for (Eigen::Index c = 0; c < count; ++c) {
    const RowRange& range = clusters.stretches[static_cast<std::size_t>(c)];
    const auto part = left_.middleRows(static_cast<Eigen::Index>(range.begin),
                                       static_cast<Eigen::Index>(range.size()));
    along_offset_.row(c) = part.col(basis_columns_).transpose() * part;
    along_residual_.row(c) =
        part.col(basis_columns_ + 1).transpose() * part.leftCols(basis_columns_);
  }
  cut_into_runs();
}

void FeatureScorer::add_movement_of(std::size_t m, const Whitening& whitening) {
  const RowRange& range = clusters_.movements[m];
  movements_.push_back({range.begin, {}, whitening.offset_of(m)});
  for (std::size_t k = 0; k < range.size(); ++k) {
    left_(static_cast<Eigen::Index>(range.begin + k), basis_columns_) =
        static_cast<float>(filter_.offset(k));
  }
}

void FeatureScorer::cut_into_runs() {
  const auto sign = [&](std::size_t row) {
    return direction_.size() == 0 ? 1.0F : direction_[static_cast<Eigen::Index>(row)];
  };
  for (std::size_t c = 0; c < clusters_.stretches.size(); ++c) {
    std::vector<Run>& runs = movements_[clusters_.movement_of[c]].runs;
    const std::size_t stretch_begin = clusters_.stretches[c].begin;
    for (std::size_t i = stretch_begin; i < clusters_.stretches[c].end; ++i) {
      const bool both = sign(i) == 0;
      const int half = sign(i) < 0 ? 1 : 0;
      const bool goes_on = i > stretch_begin && !both && !runs.back().both &&
                           runs.back().half == half &&
                           runs.back().end - runs.back().begin < kRowsAtOnce;
      if (goes_on) {
        ++runs.back().end;
      } else {
        runs.push_back({i, i + 1, c, half, both});
      }
    }
  }
}

// Of the row's features that which stands in this half.
float FeatureScorer::part_of(std::size_t row, std::size_t half) const {
  if (direction_.size() == 0) return 1;
  const float s = direction_[static_cast<Eigen::Index>(row)];
  return (half == 0 ? 1 + s : 1 - s) / 2;
}

// missed: of the row before and this half; becomes this row's. Features in the half or not.
void FeatureScorer::begin_row(const FloatRows& features, const Movement& movement, std::size_t row,
                              std::size_t half, float* missed) const {
  const auto count = static_cast<std::size_t>(features.cols());
  const float* now = features.data() + row * count;
  const float part = part_of(row, half);
  if (row == movement.begin) {
    for (std::size_t j = 0; j < count; ++j) missed[j] = part * now[j];
    return;
  }
  const float* before = now - count;
  const auto carried = static_cast<float>(filter_.carried()) * part_of(row - 1, half);
  const auto returned = static_cast<float>(filter_.returned(row - movement.begin));
  for (std::size_t j = 0; j < count; ++j) {
    const float faded = returned * missed[j];
    missed[j] = part * now[j] - carried * before[j] + (std::abs(faded) < kFaded ? 0.0F : faded);
  }
}

void FeatureScorer::add_run(const FloatRows& features, const Movement& movement, const Run& run,
                            float weight, Sums& sums) const {
  const std::size_t rows = run.end - run.begin;
  const auto half = static_cast<std::size_t>(run.half);
  float* missed = sums.missed.data() + half * sums.width;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t row = run.begin + i;
    begin_row(features, movement, row, half, missed);
    const float scale = weight * static_cast<float>(filter_.scale(row - movement.begin));
    float* out = sums.difference.data() + i * sums.width;
    for (std::size_t j = 0; j < sums.count; ++j) out[j] = scale * missed[j];
  }
  const float* difference = sums.difference.data();
  add_product(difference, sums.width, difference, sums.width, rows, true, sums.gram[half].data());
  sums.products.setZero();
  add_product(left_.data() + run.begin * static_cast<std::size_t>(left_.cols()),
              static_cast<std::size_t>(left_.cols()), difference, sums.width, rows, false,
              sums.products.data());
  const auto width = static_cast<Eigen::Index>(sums.width);
  const Eigen::Index first = run.half * width;
  sums.model.middleCols(first, width) += sums.products;
  sums.offset.segment(first, width) += sums.products.row(basis_columns_);
  sums.scores.row(static_cast<Eigen::Index>(run.stretch)).segment(first, width) +=
      sums.products.row(basis_columns_ + 1);
}

// What each row of the run still has of the row before it, and as it comes out in the movement's
// weight.
struct FeatureScorer::Fading {
  Eigen::VectorXf left;
  Eigen::VectorXf out;
};

FeatureScorer::Fading FeatureScorer::fading_of(const Movement& movement, const Run& run,
                                               float weight) const {
  const auto rows = static_cast<Eigen::Index>(run.end - run.begin);
  Fading fading{Eigen::VectorXf(rows), Eigen::VectorXf(rows)};
  float left = 1;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t k = run.begin + static_cast<std::size_t>(i) - movement.begin;
    if (i > 0) left *= static_cast<float>(filter_.returned(k));
    if (left < kFaded) left = 0;
    fading.left[i] = left;
    fading.out[i] = weight * static_cast<float>(filter_.scale(k)) * left;
  }
  return fading;
}

// What the half without features still has of the rows before the run: one row of columns, fading.
void FeatureScorer::add_other_half(const FloatRows& features, const Movement& movement,
                                   const Run& run, float weight, Sums& sums) const {
  const std::size_t other = 1 - static_cast<std::size_t>(run.half);
  const auto width = static_cast<Eigen::Index>(sums.width);
  Eigen::Map<Eigen::RowVectorXf> missed(sums.missed.data() + other * sums.width, width);
  begin_row(features, movement, run.begin, other, missed.data());
  if (missed.isZero(0)) return;
  const Fading fading = fading_of(movement, run, weight);
  const Eigen::Index rows = fading.out.size();
  const Eigen::Map<const FloatRows> difference(sums.difference.data(), rows, width);
  const Eigen::RowVectorXf own = fading.out.transpose() * difference;
  const Eigen::RowVectorXf left =
      fading.out.transpose() * left_.middleRows(static_cast<Eigen::Index>(run.begin), rows);
  const Eigen::Index first = static_cast<Eigen::Index>(other) * width;
  // The lower blocks are read: the backward half's rows, the forward half's columns.
  auto across = sums.rest.block(width, 0, width, width);
  if (other == 1) {
    across.noalias() += missed.transpose() * own;
  } else {
    across.noalias() += own.transpose() * missed;
  }
  sums.rest.block(first, first, width, width).noalias() +=
      (fading.out.squaredNorm() * missed).transpose() * missed;
  sums.model.middleCols(first, width).noalias() += left.transpose() * missed;
  sums.offset.segment(first, width) += left[basis_columns_] * missed;
  sums.scores.row(static_cast<Eigen::Index>(run.stretch)).segment(first, width) +=
      left[basis_columns_ + 1] * missed;
  missed *= fading.left[rows - 1];
}

// A row without a direction has half of its features in either half.
void FeatureScorer::add_row_of_both(const FloatRows& features, const Movement& movement,
                                    const Run& run, float weight, Sums& sums) const {
  for (std::size_t half = 0; half < 2; ++half) {
    begin_row(features, movement, run.begin, half, sums.missed.data() + half * sums.width);
  }
  const float scale = weight * static_cast<float>(filter_.scale(run.begin - movement.begin));
  const Eigen::RowVectorXf z =
      scale * Eigen::Map<const Eigen::RowVectorXf>(sums.missed.data(), sums.scores.cols());
  const auto left = left_.row(static_cast<Eigen::Index>(run.begin));
  sums.rest.noalias() += z.transpose() * z;
  sums.model.noalias() += left.transpose() * z;
  sums.offset += left[basis_columns_] * z;
  sums.scores.row(static_cast<Eigen::Index>(run.stretch)) += left[basis_columns_ + 1] * z;
}

// Of the movement's rows z what shrinking their part along the offset's direction u takes:
// (1 - kept) u u'z / u'u.
void FeatureScorer::take_offset_out(const Movement& movement, Sums& sums) const {
  const auto length = static_cast<float>(movement.offset.length);
  const auto kept = static_cast<float>(movement.offset.kept);
  const Eigen::RowVectorXf shift = (1 - kept) / length * sums.offset;
  const float square = (1 - kept * kept) / length;
  const auto width = static_cast<Eigen::Index>(sums.width);
  for (Eigen::Index a = 0; a < sums.offset.size(); a += width) {
    const auto left = sums.offset.segment(a, width);
    if (left.isZero(0)) continue;
    for (Eigen::Index b = 0; b <= a; b += width) {
      sums.rest.block(a, b, width, width).noalias() -=
          (square * left).transpose() * sums.offset.segment(b, width);
    }
  }
  for (std::size_t c = movement.runs.front().stretch; c <= movement.runs.back().stretch; ++c) {
    const auto along = along_offset_.row(static_cast<Eigen::Index>(c));
    sums.model.noalias() -= along.transpose() * shift;
    sums.scores.row(static_cast<Eigen::Index>(c)) -= along[basis_columns_ + 1] * shift;
  }
  sums.offset.setZero();
}

void FeatureScorer::add_movement(const FloatRows& features, std::size_t m, Sums& sums) const {
  const auto weight = static_cast<float>(clusters_.weight_of(m));
  std::ranges::fill(sums.missed, 0.0F);
  for (const Run& run : movements_[m].runs) {
    if (run.both) {
      add_row_of_both(features, movements_[m], run, weight, sums);
      continue;
    }
    add_run(features, movements_[m], run, weight, sums);
    if (direction_.size() > 0) add_other_half(features, movements_[m], run, weight, sums);
  }
  take_offset_out(movements_[m], sums);
}

BlockScores FeatureScorer::score(const FloatRows& features, double ridge) const {
  const std::size_t halves = direction_.size() == 0 ? 1 : 2;
  Sums sums(static_cast<std::size_t>(features.cols()), halves, left_.cols(),
            clusters_.stretches.size());
  for (std::size_t m = 0; m < movements_.size(); ++m) add_movement(features, m, sums);
  const auto width = static_cast<Eigen::Index>(sums.width);
  Eigen::MatrixXd gram = sums.rest.cast<double>();
  std::vector<Eigen::Index> columns;
  for (std::size_t h = 0; h < halves; ++h) {
    const Eigen::Index first = static_cast<Eigen::Index>(h) * width;
    gram.block(first, first, width, width) += sums.gram[h].cast<double>();
    for (Eigen::Index j = 0; j < features.cols(); ++j) columns.push_back(first + j);
  }
  const Eigen::MatrixXd model = sums.model.topRows(basis_columns_).cast<double>();
  gram.noalias() -= model.transpose() * model;
  const Eigen::MatrixXd scores =
      sums.scores.cast<double>() - along_residual_.cast<double>() * model;
  return score_sums(gram(columns, columns), scores(Eigen::all, columns), ridge);
}

}  // namespace tribench::loop
