// SPDX-License-Identifier: MIT
#include "algorithms/inference/feature_scores.hpp"

#include <algorithm>
#include <cstring>

#include "algorithms/expression/vector/each_level.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kRowsAtOnce = 64;
constexpr std::size_t kLanes = 8;
constexpr std::size_t kLeftAtOnce = 4;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

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
  FloatRows model;                // left' features; the last rows are not used
  FloatRows scores;               // per stretch
  std::vector<FloatRows> gram;    // of either half, lower blocks
  FloatRows rest;                 // of the Gram matrix, both halves
  Eigen::RowVectorXf offset;      // of the present movement: the offset's direction' features
};

FeatureScorer::FeatureScorer(const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual,
                             const Clusters& clusters, const Noise& noise,
                             const Eigen::VectorXf& direction)
    : clusters_(clusters),
      share_(static_cast<float>(noise.whitening)),
      direction_(direction),
      basis_columns_(basis.cols()) {
  const auto rows = static_cast<Eigen::Index>(clusters.rows);
  const auto width = padded(static_cast<std::size_t>(basis_columns_) + 2, kLeftAtOnce);
  left_ = FloatRows::Zero(rows, static_cast<Eigen::Index>(width));
  left_.leftCols(basis_columns_) = basis.cast<float>();
  left_.col(basis_columns_ + 1) = residual.cast<float>();
  for (std::size_t m = 0; m < clusters.movements.size(); ++m) {
    const RowRange& range = clusters.movements[m];
    Movement movement;
    movement.offset = offset_direction(clusters, m, noise);
    left_.col(basis_columns_)
        .segment(static_cast<Eigen::Index>(range.begin), static_cast<Eigen::Index>(range.size()))
        .setConstant(static_cast<float>(movement.offset.next));
    left_(static_cast<Eigen::Index>(range.begin), basis_columns_) =
        static_cast<float>(movement.offset.first);
    movements_.push_back(std::move(movement));
  }
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

void FeatureScorer::cut_into_runs() {
  const auto sign = [&](std::size_t row) {
    return direction_.size() == 0 ? 1.0F : direction_[static_cast<Eigen::Index>(row)];
  };
  for (std::size_t c = 0; c < clusters_.stretches.size(); ++c) {
    const std::size_t m = clusters_.movement_of[c];
    std::vector<Run>& runs = movements_[m].runs;
    const std::size_t stretch_begin = clusters_.stretches[c].begin;
    for (std::size_t i = stretch_begin; i < clusters_.stretches[c].end; ++i) {
      const bool turns = i > clusters_.movements[m].begin && share_ != 0 && sign(i) != sign(i - 1);
      const bool mixed = turns || sign(i) == 0;
      const int half = sign(i) < 0 ? 1 : 0;
      const bool goes_on = i > stretch_begin && !mixed && !runs.back().mixed &&
                           runs.back().half == half &&
                           runs.back().end - runs.back().begin < kRowsAtOnce;
      if (goes_on) {
        ++runs.back().end;
      } else {
        runs.push_back({i, i + 1, c, half, mixed});
      }
    }
  }
}

// The row less its share of the one before, in the movement's weight.
void FeatureScorer::write_difference(const FloatRows& features, const Movement& movement,
                                     std::size_t row, float weight, float* out) const {
  const auto count = static_cast<std::size_t>(features.cols());
  const float* now = features.data() + row * count;
  if (row == movement.runs.front().begin) {
    const auto scale = weight * static_cast<float>(movement.offset.first);
    for (std::size_t j = 0; j < count; ++j) out[j] = scale * now[j];
    return;
  }
  const float* before = now - count;
  for (std::size_t j = 0; j < count; ++j) out[j] = weight * (now[j] - share_ * before[j]);
}

void FeatureScorer::add_run(const FloatRows& features, const Movement& movement, const Run& run,
                            float weight, Sums& sums) const {
  const std::size_t rows = run.end - run.begin;
  for (std::size_t i = 0; i < rows; ++i) {
    write_difference(features, movement, run.begin + i, weight,
                     sums.difference.data() + i * sums.width);
  }
  const float* difference = sums.difference.data();
  const auto half = static_cast<std::size_t>(run.half);
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

// A row at a reversal: its own features in one half, those of the row before in the other.
void FeatureScorer::add_mixed_row(const FloatRows& features, const Movement& movement,
                                  const Run& run, float weight, Sums& sums) const {
  const auto width = static_cast<Eigen::Index>(sums.width);
  const auto count = static_cast<Eigen::Index>(sums.count);
  Eigen::RowVectorXf z = Eigen::RowVectorXf::Zero(sums.scores.cols());
  const auto add = [&](std::size_t row, double factor) {
    const float s = direction_[static_cast<Eigen::Index>(row)];
    const auto own = features.row(static_cast<Eigen::Index>(row));
    z.head(count) += static_cast<float>(factor) * weight * (1 + s) / 2 * own;
    z.segment(width, count) += static_cast<float>(factor) * weight * (1 - s) / 2 * own;
  };
  if (run.begin == movement.runs.front().begin) {
    add(run.begin, movement.offset.first);
  } else {
    add(run.begin, 1);
    add(run.begin - 1, -static_cast<double>(share_));
  }
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
  for (const Run& run : movements_[m].runs) {
    if (run.mixed) {
      add_mixed_row(features, movements_[m], run, weight, sums);
    } else {
      add_run(features, movements_[m], run, weight, sums);
    }
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
