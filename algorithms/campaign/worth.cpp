// SPDX-License-Identifier: MIT
#include "algorithms/campaign/worth.hpp"

#include <algorithm>

#include "algorithms/inference/whitening.hpp"

namespace tribench::loop {
namespace {

// No more than the error of the other effects' shapes may be (docs/decisions.md).
constexpr double kSlight = 0.03;
// Of what is left, by root mean square a tenth of it: what has no name has nothing else to show.
constexpr double kLeastWorthOfLeftover = 0.01;

double squared_error(const LoopModel& model, const Campaign& campaign,
                     const Eigen::MatrixXd& columns = {}, double ridge = 0) {
  Noise plain;
  plain.within_sd = 1;
  const Eigen::VectorXd residual = target_vector(campaign.data) - predict(model, campaign.data);
  Eigen::MatrixXd x = told_tangent(model, campaign);
  if (columns.size() > 0) x = beside(x, columns);
  return held_out_losses(whitened(std::move(x), campaign.clusters, plain),
                         whitened(residual, campaign.clusters, plain), campaign.clusters, plain,
                         ridge > 0 ? columns.cols() : 0, ridge)
      .sum();
}

}  // namespace

std::vector<double> worths(const LoopModel& model, const std::vector<std::size_t>& families,
                           const Campaign& campaign) {
  const double with = squared_error(model, campaign);
  std::vector<double> all;
  for (const std::size_t family : families) {
    all.push_back(squared_error(model.without(family), campaign) / with - 1);
  }
  return all;
}

double least_worth(const std::vector<double>& beside, const DiagnosisOptions& options) {
  if (!options.has("slight") || beside.empty()) return -1;
  return kSlight * std::min(1.0, std::ranges::max(beside));
}

double least_worth_of_leftover(const LoopModel& model, const std::vector<std::size_t>& families,
                               const Campaign& campaign) {
  const std::vector<double> found = worths(model, families, campaign);
  return std::max(kLeastWorthOfLeftover, least_worth(found, campaign.options));
}

double worth_of(const Eigen::MatrixXd& columns, const LoopModel& model, const Campaign& campaign,
                double ridge) {
  return squared_error(model, campaign) / squared_error(model, campaign, columns, ridge) - 1;
}

}  // namespace tribench::loop
