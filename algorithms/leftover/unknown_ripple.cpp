// SPDX-License-Identifier: MIT
#include "algorithms/leftover/unknown_ripple.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "algorithms/campaign/round.hpp"
#include "algorithms/campaign/worth.hpp"
#include "algorithms/inference/whitening.hpp"
#include "algorithms/loop_model/smoothers.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kFewestWaves = 2;      // over the travel: less is no repetition
constexpr double kShortestInMeans = 2;  // Nyquist 1928: what is shorter looks like what is longer
constexpr int kRefinements = 24;        // of a wavenumber: to 1e-5 of a step
constexpr int kMostWaves = 3;           // one beside another: a ripple and two of its harmonics

// What the model and the waves found so far leave over.
class WaveSearch {
 public:
  WaveSearch(const FittedModel& model, const Campaign& campaign, const WaveRange& range)
      : campaign_(campaign),
        noise_(model.noise),
        range_(range),
        whitening_(campaign.clusters, model.noise),
        basis_(model.basis),
        residual_(model.residual) {}

  // None at the level of what is left over.
  std::optional<Wave> next(RandomStream random) const {
    const double alpha = campaign_.options.alpha_leftover;
    // As many as that level takes: each looks at every wavenumber.
    const auto flips =
        std::min(campaign_.options.flips, static_cast<std::size_t>(std::ceil(1 / alpha)));
    Wave wave = strongest_wave(campaign_.data.find("q")->values, whitening_.adjoint(residual_),
                               direction_of(campaign_.data), campaign_.clusters, range_, flips,
                               alpha, random);
    if (wave.p > alpha) return {};
    wave.wavenumber = top_of(wave);
    return wave;
  }

  void put_beside(const Wave& wave) {
    basis_ = orthonormal_basis(
        beside(basis_, whitened(wave_columns(wave, campaign_.data), campaign_.clusters, noise_)));
    residual_ = project_off(residual_, basis_);
  }

 private:
  double explained(Wave wave, double wavenumber) const {
    wave.wavenumber = wavenumber;
    const Eigen::MatrixXd z =
        whitened(wave_columns(wave, campaign_.data), campaign_.clusters, noise_);
    return score_statistic(z, basis_, residual_);
  }

  // Up the hill, step by step, then golden section. What is most certain stands beside the top:
  // where every stretch agrees a wave cannot become more certain.
  double top_of(const Wave& wave) const {
    constexpr double kGolden = std::numbers::phi - 1;
    double top = wave.wavenumber;
    for (const double step : {-range_.step, range_.step}) {
      double here = explained(wave, top);
      for (double next = top + step; next >= range_.low && next <= range_.high; next += step) {
        const double there = explained(wave, next);
        if (there <= here) break;
        here = there;
        top = next;
      }
    }
    double low = top - range_.step;
    double high = top + range_.step;
    const auto inner = [&](double from, double to) { return to - kGolden * (to - from); };
    const auto at = [&](double k) { return std::pair(k, explained(wave, k)); };
    auto left = at(inner(low, high));
    auto right = at(inner(high, low));
    for (int n = 0; n < kRefinements; ++n) {
      if (left.second > right.second) {
        high = std::exchange(right, left).first;
        left = at(inner(low, high));
      } else {
        low = std::exchange(left, right).first;
        right = at(inner(high, low));
      }
    }
    return (low + high) / 2;
  }

  const Campaign& campaign_;
  const Noise& noise_;
  WaveRange range_;
  Whitening whitening_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd residual_;
};

}  // namespace

bool repeats_with_the_gear(const EffectFamily& family) {
  return std::ranges::any_of(family.atoms, [](const AtomTemplate& atom) {
    return std::ranges::count(atom.shapes, ShapeValues::gear_ratios, &ShapeTemplate::values) > 0;
  });
}

std::optional<WaveRange> ripples_looked_for(const Campaign& campaign) {
  const Signal* position = campaign.data.find("q");
  if (position == nullptr || campaign.clusters.stretches.size() < kFewestClusters) return {};
  if (std::ranges::none_of(campaign.families, repeats_with_the_gear)) return {};
  const bool is_linear = position->unit == "m";
  const double mean = is_linear ? kBlockLength : kBlockAngle;
  std::optional<WaveRange> range =
      waves_over(position->values, kFewestWaves, kShortestInMeans * mean);
  if (range && !is_linear) range->low = std::max(range->low, kMostWavesOfOutput + 0.5);
  if (!range || range->low >= range->high) return {};
  return range;
}

std::optional<Wave> unknown_ripple(const FittedModel& model, const Campaign& campaign,
                                   RandomStream random) {
  const std::optional<WaveRange> range = ripples_looked_for(campaign);
  if (!range) return {};
  // The most certain wave need not be the largest: the noise takes a large one for correlation of
  // its own, so that a harmonic of it stands out.
  WaveSearch search(model, campaign, *range);
  std::optional<Wave> largest;
  double most = 0;
  for (int k = 0; k < kMostWaves; ++k) {
    const std::optional<Wave> wave = search.next(random.split(static_cast<std::uint64_t>(k)));
    if (!wave) break;
    const double worth = worth_of(wave_columns(*wave, campaign.data), model.model, campaign);
    if (!largest || worth > most) {
      most = worth;
      largest = wave;
    }
    search.put_beside(*wave);
  }
  return largest;
}

Eigen::MatrixXd wave_columns(const Wave& wave, const Observations& data) {
  const std::vector<double>& position = data.find("q")->values;
  const Eigen::Map<const Eigen::VectorXd> q(position.data(),
                                            static_cast<Eigen::Index>(position.size()));
  Eigen::MatrixXd columns = (wave.wavenumber * q).replicate(1, 2);
  elementary::cos_of_each({columns.col(0).data(), position.size()});
  elementary::sin_of_each({columns.col(1).data(), position.size()});
  if (wave.is_turned) columns = direction_of(data).cast<double>().asDiagonal() * columns;
  return columns;
}

}  // namespace tribench::loop
