// SPDX-License-Identifier: MIT
#include "reports/statistics/log_ratios.hpp"

#include <cmath>
#include <cstddef>
#include <set>

#include "foundation/elementary.hpp"

namespace tribench {

bool LogRatios::is_pair(double reference, double figure) {
  const bool has_both = !std::isnan(reference) && !std::isnan(figure);
  return has_both && !(std::isinf(reference) && std::isinf(figure));
}

void LogRatios::add(double reference, double figure) {
  if (!is_pair(reference, figure)) return;
  figures_.emplace_back(reference, figure);
  all_.push_back(reference == figure ? 0.0 : elementary::log(figure / reference));
}

void LogRatios::shift(double by) {
  for (double& ratio : all_) ratio += by;
}

std::vector<double> LogRatios::distinct() const {
  std::set<std::pair<double, double>> seen;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const bool is_equal = figures_[i].first == figures_[i].second;
    if (is_equal || seen.insert(figures_[i]).second) ratios.push_back(all_[i]);
  }
  return ratios;
}

}  // namespace tribench
