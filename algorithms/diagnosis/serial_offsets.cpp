// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/serial_offsets.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/loop_model/smoothers.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kFewestMovements = 20;

double squared_steps(const std::vector<double>& offsets) {
  double sum = 0;
  for (std::size_t m = 1; m < offsets.size(); ++m) {
    sum += (offsets[m] - offsets[m - 1]) * (offsets[m] - offsets[m - 1]);
  }
  return sum;
}

// In the order of time.
std::vector<double> offsets_of(const Eigen::VectorXd& residual, const std::vector<double>& time,
                               const std::vector<RowRange>& movements) {
  std::vector<std::pair<double, double>> ordered;
  for (const RowRange& rows : movements) {
    const auto begin = static_cast<Eigen::Index>(rows.begin);
    const auto size = static_cast<Eigen::Index>(rows.size());
    const Eigen::Map<const Eigen::VectorXd> t(time.data() + begin, size);
    ordered.emplace_back(t.mean(), residual.segment(begin, size).mean());
  }
  std::ranges::sort(ordered);
  std::vector<double> offsets;
  for (const auto& [when, offset] : ordered) offsets.push_back(offset);
  return offsets;
}

}  // namespace

std::optional<double> serial_offsets_p(const FittedModel& fit, const Campaign& campaign,
                                       RandomStream random) {
  const Signal* t = campaign.data.find("t");
  const std::vector<RowRange>& movements = campaign.clusters.movements;
  if (t == nullptr || movements.size() < kFewestMovements) return std::nullopt;
  std::vector<double> offsets = offsets_of(fit.raw_residual, t->values, movements);
  const double seen = squared_steps(offsets);
  const std::size_t orders = campaign.options.flips;
  std::size_t as_small = 1;
  for (std::size_t k = 0; k < orders; ++k) {
    random.shuffle(std::span(offsets));
    if (squared_steps(offsets) <= seen) ++as_small;
  }
  return static_cast<double>(as_small) / static_cast<double>(orders + 1);
}

Eigen::MatrixXd time_of_movements(const Campaign& campaign) {
  Observations data;
  data.movement = campaign.data.movement;
  Signal t = *campaign.data.find("t");
  for (const RowRange& rows : campaign.clusters.movements) {
    const auto begin = static_cast<Eigen::Index>(rows.begin);
    Eigen::Map<Eigen::VectorXd> own(t.values.data() + begin,
                                    static_cast<Eigen::Index>(rows.size()));
    own.setConstant(own.mean());
  }
  data.signals.push_back(std::move(t));
  return smooth_single(data, "t").features.cast<double>();
}

}  // namespace tribench::loop
