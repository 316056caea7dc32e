// SPDX-License-Identifier: MIT
#include "algorithms/leftover/serial_offsets.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/loop_model/smoothers.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kFewestMovements = 20;
constexpr int kMostCentres = 24;  // as many as a smoother of the time has

double squared_steps(const std::vector<double>& means) {
  double sum = 0;
  for (std::size_t m = 1; m < means.size(); ++m) {
    sum += (means[m] - means[m - 1]) * (means[m] - means[m - 1]);
  }
  return sum;
}

// Of each movement, in the order of time.
std::vector<double> means_of(const Eigen::VectorXd& values, const std::vector<double>& time,
                             const std::vector<RowRange>& movements) {
  std::vector<std::pair<double, double>> ordered;
  for (const RowRange& rows : movements) {
    const auto begin = static_cast<Eigen::Index>(rows.begin);
    const auto size = static_cast<Eigen::Index>(rows.size());
    const Eigen::Map<const Eigen::VectorXd> t(time.data() + begin, size);
    ordered.emplace_back(t.mean(), values.segment(begin, size).mean());
  }
  std::ranges::sort(ordered);
  std::vector<double> means;
  for (const auto& [when, mean] : ordered) means.push_back(mean);
  return means;
}

// The share of orders in which they would be so much like their neighbours.
double share_of_orders(std::vector<double> means, std::size_t orders, RandomStream random) {
  const double seen = squared_steps(means);
  std::size_t as_small = 1;
  for (std::size_t k = 0; k < orders; ++k) {
    random.shuffle(std::span(means));
    if (squared_steps(means) <= seen) ++as_small;
  }
  return static_cast<double>(as_small) / static_cast<double>(orders + 1);
}

}  // namespace

std::optional<double> serial_offsets_p(const FittedModel& fit, const Campaign& campaign,
                                       RandomStream random) {
  const Signal* t = campaign.data.find("t");
  const std::vector<RowRange>& movements = campaign.clusters.movements;
  if (t == nullptr || movements.size() < kFewestMovements) return std::nullopt;
  const auto p_of = [&](const Eigen::VectorXd& values, const char* name) {
    return share_of_orders(means_of(values, t->values, movements), campaign.options.flips,
                           random.split(name));
  };
  const double of_offsets = p_of(fit.raw_residual, "offsets");
  const Eigen::VectorXd direction = direction_of(campaign.data).cast<double>();
  if (direction.size() == 0) return of_offsets;
  const double of_friction = p_of(fit.raw_residual.cwiseProduct(direction), "friction");
  return std::min(1.0, 2 * std::min(of_offsets, of_friction));
}

Eigen::MatrixXd time_of_movements(const Campaign& campaign) {
  Observations data;
  data.movement = campaign.data.movement;
  if (const Signal* sign = campaign.data.find("sgn_v")) data.signals.push_back(*sign);
  Signal t = *campaign.data.find("t");
  for (const RowRange& rows : campaign.clusters.movements) {
    const auto begin = static_cast<Eigen::Index>(rows.begin);
    Eigen::Map<Eigen::VectorXd> own(t.values.data() + begin,
                                    static_cast<Eigen::Index>(rows.size()));
    own.setConstant(own.mean());
  }
  data.signals.push_back(std::move(t));
  const auto movements = static_cast<int>(campaign.clusters.movements.size());
  return with_direction(smooth_single(data, "t", std::min(kMostCentres, movements / 3)), data);
}

}  // namespace tribench::loop
