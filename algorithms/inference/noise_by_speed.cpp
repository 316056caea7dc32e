// SPDX-License-Identifier: MIT
#include "algorithms/inference/noise_by_speed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kSpeeds = 8;  // groups of equal size

}  // namespace

NoiseBySpeed::NoiseBySpeed(std::span<const double> speed, std::span<const double> deviation,
                           double robust_sd)
    : robust_sd_(robust_sd), rows_(deviation.size()) {
  if (rows_ < 4 * kSpeeds || speed.empty()) return;
  speed_.assign(speed.begin(), speed.end());
  by_speed_.resize(rows_);
  std::iota(by_speed_.begin(), by_speed_.end(), std::size_t{0});
  std::ranges::stable_sort(by_speed_, {}, [&](std::size_t i) { return speed_[i]; });
  for (std::size_t g = 0; g < kSpeeds; ++g) {
    std::vector<double> magnitudes;
    for (const std::size_t i : rows_of(g)) magnitudes.push_back(std::abs(deviation[i]));
    const double sd = kMadToSd * median(magnitudes);
    middle_speed_.push_back(speed_[by_speed_[rows_ * (2 * g + 1) / (2 * kSpeeds)]]);
    log_level_.push_back(elementary::log(std::max(sd / robust_sd_, kLeastLevel)));
  }
}

std::span<const std::size_t> NoiseBySpeed::rows_of(std::size_t group) const {
  const std::size_t first = rows_ * group / kSpeeds;
  return std::span(by_speed_).subspan(first, rows_ * (group + 1) / kSpeeds - first);
}

void NoiseBySpeed::refine(std::span<const double> innovation, const StudentLaw& law) {
  for (std::size_t g = 0; g < log_level_.size(); ++g) {
    std::vector<double> z;
    for (const std::size_t i : rows_of(g)) z.push_back(innovation[i]);
    const double level = level_of(z, law, 1, kLevelIterations);
    log_level_[g] += elementary::log(std::max(level, kLeastLevel));
  }
}

std::vector<double> NoiseBySpeed::units() const {
  std::vector<double> units(rows_, robust_sd_);
  for (std::size_t i = 0; i < speed_.size(); ++i) {
    std::size_t g = 1;
    while (g + 1 < kSpeeds && speed_[i] > middle_speed_[g]) ++g;
    const double width = middle_speed_[g] - middle_speed_[g - 1];
    const double part =
        width > 0 ? std::clamp((speed_[i] - middle_speed_[g - 1]) / width, -0.5, 1.5) : 1;
    const double log_level = log_level_[g - 1] + part * (log_level_[g] - log_level_[g - 1]);
    units[i] = robust_sd_ * elementary::exp(log_level);
  }
  return units;
}

double NoiseBySpeed::variance(const StudentLaw& law, double spread,
                              std::span<const RowRange> movements) const {
  std::vector<std::size_t> movement_of(rows_);
  for (std::size_t m = 0; m < movements.size(); ++m) {
    std::fill(movement_of.begin() + static_cast<std::ptrdiff_t>(movements[m].begin),
              movement_of.begin() + static_cast<std::ptrdiff_t>(movements[m].end), m);
  }
  double sum = 0;
  for (std::size_t g = 0; g < log_level_.size(); ++g) {
    std::vector<double> rows_in(movements.size(), 0.0);
    const std::span<const std::size_t> rows = rows_of(g);
    for (const std::size_t i : rows) ++rows_in[movement_of[i]];
    double squares = 0;
    for (const double n : rows_in) squares += n * n;
    const auto n = static_cast<double>(rows.size());
    sum += law.variance_of_log_level(n) + spread * squares / (n * n);
  }
  return log_level_.empty() ? 0 : sum / static_cast<double>(log_level_.size());
}

}  // namespace tribench::loop
