// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/unknown_ripple.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "algorithms/diagnosis/round.hpp"
#include "algorithms/inference/whitening.hpp"
#include "algorithms/loop_model/smoothers.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr double kFewestWaves = 2;      // over the travel: less is no repetition
constexpr double kShortestInMeans = 5;  // a mean over a fifth of a wave keeps 93 % of it
constexpr int kRefinements = 24;        // of a wavenumber: to 1e-5 of a step

// What a wave of this length explains of the residual beside the model.
double explained(Wave wave, double wavenumber, const FittedModel& model, const Campaign& campaign) {
  wave.wavenumber = wavenumber;
  const Eigen::MatrixXd z =
      whitened(wave_columns(wave, campaign.data), campaign.clusters, model.noise);
  return score_block(z, model.basis, model.residual, campaign.clusters).test.statistic;
}

// Golden section between the neighbours of one of the range.
double between_steps(const Wave& wave, double step, const FittedModel& model,
                     const Campaign& campaign) {
  constexpr double kGolden = std::numbers::phi - 1;
  double low = wave.wavenumber - step;
  double high = wave.wavenumber + step;
  const auto inner = [&](double from, double to) { return to - kGolden * (to - from); };
  const auto at = [&](double k) { return std::pair(k, explained(wave, k, model, campaign)); };
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

}  // namespace

bool repeats_with_the_gear(const EffectFamily& family) {
  return std::ranges::any_of(family.atoms, [](const AtomTemplate& atom) {
    return std::ranges::count(atom.shapes, ShapeValues::gear_ratios, &ShapeTemplate::values) > 0;
  });
}

std::optional<Wave> unknown_ripple(const FittedModel& model, const Campaign& campaign,
                                   RandomStream random) {
  const Signal* position = campaign.data.find("q");
  if (position == nullptr || campaign.clusters.stretches.size() < kFewestClusters) return {};
  if (std::ranges::none_of(campaign.families, repeats_with_the_gear)) return {};
  const bool is_linear = position->unit == "m";
  const double mean = is_linear ? kBlockLength : kBlockAngle;
  std::optional<WaveRange> range =
      waves_over(position->values, kFewestWaves, kShortestInMeans * mean);
  if (range && !is_linear) range->low = std::max(range->low, kMostWavesOfOutput + 0.5);
  if (!range || range->low >= range->high) return {};
  const Whitening whitening(campaign.clusters, model.noise);
  const double alpha = campaign.options.alpha_leftover;
  Wave wave = strongest_wave(position->values, whitening.adjoint(model.residual),
                             direction_of(campaign.data), campaign.clusters, *range,
                             campaign.options.flips, alpha, random);
  if (wave.p > alpha) return {};
  wave.wavenumber = between_steps(wave, range->step, model, campaign);
  return wave;
}

Eigen::MatrixXd wave_columns(const Wave& wave, const Observations& data) {
  const std::vector<double>& position = data.find("q")->values;
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(position.size()), 2);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    columns(row, 0) = elementary::cos(wave.wavenumber * position[i]);
    columns(row, 1) = elementary::sin(wave.wavenumber * position[i]);
  }
  if (wave.is_turned) columns = direction_of(data).cast<double>().asDiagonal() * columns;
  return columns;
}

}  // namespace tribench::loop
