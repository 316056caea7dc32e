// SPDX-License-Identifier: MIT
#include "algorithms/inference/burst_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "algorithms/inference/noise_by_speed.hpp"
#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench::loop {
namespace {

constexpr int kPasses = 2;
constexpr int kIterationsWithout = 4;  // from the level with the rows
// Fewer rows than this share of a movement's do not change its level.
constexpr std::size_t kNegligible = 50;
constexpr std::size_t kFewestRows = 3;

double median_magnitude(std::vector<double> values) {
  for (double& x : values) x = std::abs(x);
  return values.empty() ? 0 : median(values);
}

// Correlation of neighbours; clipped, so that a burst does not count for more than it is.
double neighbour_correlation(const std::vector<double>& deviation,
                             const std::vector<RowRange>& ranges, double limit) {
  double product = 0;
  double square = 0;
  for (const RowRange& m : ranges) {
    double before = 0;
    for (std::size_t i = m.begin; i < m.end; ++i) {
      const double now = std::clamp(deviation[i], -limit, limit);
      product += now * before;
      square += now * now;
      before = now;
    }
  }
  return square > 0 ? std::clamp(product / square, 0.0, 0.998) : 0;
}

}  // namespace

BurstNoise::BurstNoise(std::span<const int> movement, std::span<const double> speed,
                       const Eigen::VectorXd& residual)
    : movements_(movement_ranges(movement)),
      deviation_(movement.size()),
      unit_(movement.size(), 1.0),
      level_(movements_.size(), 1.0) {
  centre(residual);
  robust_sd_ = kMadToSd * median_magnitude(deviation_);
  if (!(robust_sd_ > 0)) return;
  NoiseBySpeed by_speed(speed, deviation_, robust_sd_);
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) by_speed.refine(innovation_, law_);
    unit_ = by_speed.units();
    innovate();
    if (pass == 0) law_ = fit_student(innovation_);
    scale_by_movement();
  }
  speed_variance_ = by_speed.variance(law_, spread_, movements_);
}

std::size_t BurstNoise::movement_at(std::size_t row) const {
  const auto next =
      std::ranges::upper_bound(movements_, row, std::ranges::less(), &RowRange::begin);
  return static_cast<std::size_t>(next - movements_.begin()) - 1;
}

// From the movement's median, as far as offsets are more than what correlated noise makes of it.
void BurstNoise::centre(const Eigen::VectorXd& residual) {
  std::vector<double> middles;
  for (const RowRange& m : movements_) {
    middles.push_back(median(std::span(residual.data() + m.begin, residual.data() + m.end)));
    for (std::size_t i = m.begin; i < m.end; ++i) {
      deviation_[i] = residual[static_cast<Eigen::Index>(i)] - middles.back();
    }
  }
  const double sd = kMadToSd * median_magnitude(deviation_);
  const double rho = neighbour_correlation(deviation_, movements_, 3 * sd);
  double spread = 0;
  double sampling = 0;
  for (std::size_t m = 0; m < movements_.size(); ++m) {
    const auto rows = static_cast<double>(movements_[m].size());
    spread += middles[m] * middles[m];
    // Of a median of normal rows, correlated by rho.
    sampling += std::numbers::pi / 2 * sd * sd * std::min((1 + rho) / (1 - rho), rows) / rows;
  }
  const double shrunk = spread > 0 ? std::clamp(sampling / spread, 0.0, 1.0) : 0;
  for (std::size_t m = 0; m < movements_.size(); ++m) {
    for (std::size_t i = movements_[m].begin; i < movements_[m].end; ++i) {
      deviation_[i] += shrunk * middles[m];
    }
  }
}

void BurstNoise::innovate() {
  std::vector<double>& z = innovation_;
  z.resize(deviation_.size());
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = deviation_[i] / unit_[i];
  rho_ = neighbour_correlation(z, movements_, 3);
  for (const RowRange& m : movements_) {
    for (std::size_t i = m.end; i-- > m.begin + 1;) z[i] -= rho_ * z[i - 1];
    z[m.begin] *= std::sqrt(1 - rho_ * rho_);
  }
}

// What `rows` rows say of a movement's level (the information in a t law about its scale), together
// with what the others say.
BurstNoise::Level BurstNoise::shrunk_level(double own, double rows) const {
  const double sampling = law_.variance_of_log_level(rows);
  const double kept = spread_ > 0 ? spread_ / (spread_ + sampling) : 0;
  return {elementary::exp(mean_log_level_ + kept * (elementary::log(own) - mean_log_level_)),
          kept * sampling};
}

void BurstNoise::divide_by_levels() {
  for (std::size_t m = 0; m < movements_.size(); ++m) {
    for (std::size_t i = movements_[m].begin; i < movements_[m].end; ++i) {
      innovation_[i] /= level_[m];
      unit_[i] *= level_[m];
    }
  }
}

void BurstNoise::scale_by_movement() {
  const auto count = static_cast<double>(movements_.size());
  std::vector<double> own;
  double sampling = 0;
  mean_log_level_ = 0;
  for (std::size_t m = 0; m < movements_.size(); ++m) {
    const auto rows = static_cast<double>(movements_[m].size());
    own.push_back(
        level_of(std::span(innovation_).subspan(movements_[m].begin, movements_[m].size()), law_, 1,
                 kLevelIterations));
    mean_log_level_ += elementary::log(own.back()) / count;
    sampling += law_.variance_of_log_level(rows) / count;
  }
  double spread = 0;
  for (const double x : own) {
    const double apart = elementary::log(x) - mean_log_level_;
    spread += apart * apart / std::max(1.0, count - 1);
  }
  spread_ = std::max(0.0, spread - sampling);
  for (std::size_t m = 0; m < movements_.size(); ++m) {
    level_[m] = shrunk_level(own[m], static_cast<double>(movements_[m].size())).factor;
  }
  divide_by_levels();
  const double before = law_.scale();
  law_ = fit_student(innovation_);
  mean_log_level_ += elementary::log(before / law_.scale());
}

double BurstNoise::level_error(std::size_t movement, std::size_t rows) const {
  const std::size_t all = movements_[movement].size();
  const double own = all < rows + kFewestRows
                         ? spread_
                         : shrunk_level(1, static_cast<double>(all - rows)).variance;
  return std::sqrt(own + speed_variance_);
}

double BurstNoise::level_without(std::size_t movement, std::size_t first, std::size_t rows) const {
  const std::size_t all = movements_[movement].size();
  if (rows * kNegligible < all) return 1;
  const double taken = level_[movement];
  if (all < rows + kFewestRows) return elementary::exp(mean_log_level_) / taken;
  const RowRange& range = movements_[movement];
  std::vector<double> others(innovation_.data() + range.begin, innovation_.data() + first);
  others.insert(others.end(), innovation_.data() + first + rows, innovation_.data() + range.end);
  const double own = taken * level_of(others, law_, 1, kIterationsWithout);
  return shrunk_level(own, static_cast<double>(all - rows)).factor / taken;
}

}  // namespace tribench::loop
