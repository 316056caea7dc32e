// SPDX-License-Identifier: MIT
#include "algorithms/inference/wave_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "algorithms/expression/vector/each_level.hpp"
#include "algorithms/inference/flips.hpp"
#include "algorithms/inference/float_lanes.hpp"
#include "algorithms/inference/score_test.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kMostWaves = 1000;       // over the span
constexpr double kStepsOfAWave = 4;       // over the span: how finely wavenumbers are taken
constexpr std::size_t kAtOnce = 32;       // wavenumbers
constexpr std::size_t kMostGroups = 100;  // of clusters: more do not sharpen the flips
constexpr std::size_t kFirstFlips = 24;   // noise shows itself in some ten
constexpr std::size_t kFlipsAtOnce = 250;

// Sums over rows of weight times cos and sin of each wavenumber, forwards and backwards apart.
struct Sums {
  explicit Sums(std::size_t wavenumbers)
      : cosine{std::vector<double>(wavenumbers), std::vector<double>(wavenumbers)}, sine(cosine) {}
  void clear() {
    for (auto* both : {&cosine, &sine}) {
      for (std::vector<double>& half : *both) std::ranges::fill(half, 0.0);
    }
  }
  std::array<std::vector<double>, 2> cosine;
  std::array<std::vector<double>, 2> sine;
};

struct Phase {
  double cosine;
  double sine;
  Phase times(const Phase& other) const {
    return {cosine * other.cosine - sine * other.sine, cosine * other.sine + sine * other.cosine};
  }
};

Phase phase_of(double angle) { return {elementary::cos(angle), elementary::sin(angle)}; }

// The phases of `kAtOnce` neighbouring wavenumbers are those of the first, turned.
TRIBENCH_EACH_LEVEL void add_block(double cosine, double sine, const double* turn_cosine,
                                   const double* turn_sine, double* sum_cosine, double* sum_sine) {
  for (std::size_t j = 0; j < kAtOnce; ++j) {
    sum_cosine[j] += cosine * turn_cosine[j] - sine * turn_sine[j];
    sum_sine[j] += cosine * turn_sine[j] + sine * turn_cosine[j];
  }
}

class Scan {
 public:
  Scan(std::span<const double> coordinate, const Eigen::VectorXd& scores,
       const Eigen::VectorXf& direction, const WaveRange& range)
      : coordinate_(coordinate), scores_(scores), direction_(direction), range_(range) {
    const auto count = static_cast<std::size_t>((range.high - range.low) / range.step) + 1;
    blocks_ = (count + kAtOnce - 1) / kAtOnce;
  }

  std::size_t wavenumbers() const { return blocks_ * kAtOnce; }
  double wavenumber(std::size_t k) const {
    return range_.low + range_.step * static_cast<double>(k);
  }

  void add_rows(std::size_t begin, std::size_t end, Sums& sums) const {
    std::array<double, kAtOnce> turn_cosine;
    std::array<double, kAtOnce> turn_sine;
    for (std::size_t i = begin; i < end; ++i) {
      const double x = coordinate_[i];
      const Phase step = phase_of(range_.step * x);
      Phase turn{1, 0};
      for (std::size_t j = 0; j < kAtOnce; ++j, turn = turn.times(step)) {
        turn_cosine[j] = turn.cosine;
        turn_sine[j] = turn.sine;
      }
      Phase at = phase_of(range_.low * x);
      const double score = scores_[static_cast<Eigen::Index>(i)];
      at = {score * at.cosine, score * at.sine};
      const std::size_t half = is_backwards(i) ? 1 : 0;
      for (std::size_t b = 0; b < blocks_; ++b, at = at.times(turn)) {
        add_block(at.cosine, at.sine, turn_cosine.data(), turn_sine.data(),
                  sums.cosine[half].data() + b * kAtOnce, sums.sine[half].data() + b * kAtOnce);
      }
    }
  }

 private:
  bool is_backwards(std::size_t row) const {
    return direction_.size() > 0 && direction_[static_cast<Eigen::Index>(row)] < 0;
  }

  std::span<const double> coordinate_;
  const Eigen::VectorXd& scores_;
  const Eigen::VectorXf& direction_;
  WaveRange range_;
  std::size_t blocks_ = 0;
};

// Neighbouring clusters together, where they are many.
std::vector<RowRange> groups_of(const Clusters& clusters) {
  const std::size_t each = (clusters.stretches.size() + kMostGroups - 1) / kMostGroups;
  std::vector<RowRange> groups;
  for (std::size_t c = 0; c < clusters.stretches.size(); c += each) {
    const std::size_t last = std::min(c + each, clusters.stretches.size()) - 1;
    groups.push_back({clusters.stretches[c].begin, clusters.stretches[last].end});
  }
  return groups;
}

// Where the pair's first column stands; its second one kLanes further (Flips::largest_squares).
std::size_t column_of(std::size_t pair) { return pair / kLanes * 2 * kLanes + pair % kLanes; }

// Two pairs of columns a wavenumber, cos and sin: without and with the direction; a row a group. A
// pair has unit length over the groups, so that the square of its sum is at most their number and
// one on average over the flips.
FloatRows pairs_of(const Scan& scan, std::span<const RowRange> groups) {
  const std::size_t wavenumbers = scan.wavenumbers();
  FloatRows all(static_cast<Eigen::Index>(groups.size()),
                static_cast<Eigen::Index>(4 * wavenumbers));
  Sums sums(wavenumbers);
  Eigen::RowVectorXf squares = Eigen::RowVectorXf::Zero(all.cols());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    sums.clear();
    scan.add_rows(groups[g].begin, groups[g].end, sums);
    float* row = all.data() + g * 4 * wavenumbers;
    for (std::size_t k = 0; k < wavenumbers; ++k) {
      for (const double sign : {1.0, -1.0}) {
        const std::size_t column = column_of(2 * k + (sign < 0 ? 1 : 0));
        row[column] = static_cast<float>(sums.cosine[0][k] + sign * sums.cosine[1][k]);
        row[column + kLanes] = static_cast<float>(sums.sine[0][k] + sign * sums.sine[1][k]);
      }
    }
    squares += all.row(static_cast<Eigen::Index>(g)).cwiseAbs2();
  }
  for (std::size_t pair = 0; pair < 2 * wavenumbers; ++pair) {
    const auto column = static_cast<Eigen::Index>(column_of(pair));
    const float square = squares[column] + squares[column + kLanes];
    const float scale = square > 0 ? 1 / std::sqrt(square) : 0;
    squares[column] = squares[column + kLanes] = scale;
  }
  for (Eigen::Index g = 0; g < all.rows(); ++g) all.row(g).array() *= squares.array();
  return all;
}

struct Peak {
  std::size_t pair = 0;
  float square = 0;
};

Peak largest_square(const Eigen::RowVectorXf& sums) {
  Peak best;
  for (std::size_t pair = 0; pair < static_cast<std::size_t>(sums.size()) / 2; ++pair) {
    const auto column = static_cast<Eigen::Index>(column_of(pair));
    const float square =
        sums[column] * sums[column] + sums[column + kLanes] * sums[column + kLanes];
    if (square > best.square) best = {pair, square};
  }
  return best;
}

double flipped_p(const FloatRows& pairs, float square, std::size_t count, double alpha,
                 RandomStream random) {
  const Flips flips(count, static_cast<std::size_t>(pairs.rows()), random);
  const double most = alpha * static_cast<double>(count + 1);  // of them at least as large
  double at_least = 1;
  std::size_t together = kFirstFlips;
  for (std::size_t first = 0; first < count && at_least <= most; first += together) {
    if (first > 0) together = kFlipsAtOnce;
    const std::size_t rows = std::min(together, count - first);
    for (const float largest : flips.largest_squares(pairs, first, rows)) {
      if (largest >= square) ++at_least;
    }
  }
  return at_least > most ? 1 : at_least / static_cast<double>(count + 1);
}

}  // namespace

std::optional<WaveRange> waves_over(std::span<const double> coordinate, double fewest,
                                    double shortest) {
  const auto [least, most] = std::ranges::minmax(coordinate);
  const double span = most - least;
  const double longest = span / fewest;
  shortest = std::max(shortest, span / kMostWaves);
  if (!(longest > shortest)) return {};
  constexpr double kTurn = 2 * std::numbers::pi;
  return WaveRange{kTurn / longest, kTurn / shortest, kTurn / span / kStepsOfAWave};
}

Wave strongest_wave(std::span<const double> coordinate, const Eigen::VectorXd& scores,
                    const Eigen::VectorXf& direction, const Clusters& clusters,
                    const WaveRange& range, std::size_t flips, double alpha, RandomStream random) {
  const double length = scores.stableNorm();
  if (!(length > 0)) return {range.low, false, 1};
  const Eigen::VectorXd of_unit_length = scores / length;  // single precision follows
  const Scan scan(coordinate, of_unit_length, direction, range);
  const FloatRows pairs = pairs_of(scan, groups_of(clusters));
  const Eigen::RowVectorXf whole = pairs.colwise().sum();
  const Peak peak = largest_square(whole);
  return {scan.wavenumber(peak.pair / 2), peak.pair % 2 == 1,
          flipped_p(pairs, peak.square, flips, alpha, random)};
}

}  // namespace tribench::loop
