// SPDX-License-Identifier: MIT
#include "algorithms/inference/burst_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench::loop {
namespace {

constexpr double kLeastShare = 0.02;  // of the typical noise a row's noise is at least
constexpr std::size_t kSpeeds = 8;    // groups of equal size
constexpr int kPasses = 2;
constexpr int kIterations = 8;         // for a level; each leaves a third of the error
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

// The scale of z as a multiple of the law's, by maximum likelihood, from `level` on.
double level_of(std::span<const double> z, const StudentLaw& law, double level, int iterations) {
  const double unit = law.scale * law.scale;
  double square = level * level * unit;
  for (int k = 0; k < iterations; ++k) {
    double sum = 0;
    for (const double x : z) sum += x * x * (law.freedom + 1) / (law.freedom + x * x / square);
    square = std::max(sum / static_cast<double>(z.size()), kLeastShare * kLeastShare * unit);
  }
  return std::sqrt(square / unit);
}

}  // namespace

BurstNoise::BurstNoise(std::span<const int> movement, std::span<const double> speed,
                       const Eigen::VectorXd& residual)
    : movements_(movement_ranges(movement)),
      deviation_(movement.size()),
      unit_(movement.size(), 1.0),
      level_(movements_.size(), 1.0),
      speed_(speed.begin(), speed.end()) {
  centre(residual);
  robust_sd_ = kMadToSd * median_magnitude(deviation_);
  if (!(robust_sd_ > 0)) return;
  group_by_speed();
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) refine_speeds();
    scale_by_speed();
    innovate();
    if (pass == 0) law_ = fit_student(innovation_);
    scale_by_movement();
  }
  speed_variance_ = variance_of_speed_levels();
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

// Groups of rows of like speed, and how wide the noise is in each, to begin with.
void BurstNoise::group_by_speed() {
  const std::size_t n = deviation_.size();
  if (n < 4 * kSpeeds) speed_.clear();
  if (speed_.empty()) return;
  by_speed_.resize(n);
  std::iota(by_speed_.begin(), by_speed_.end(), std::size_t{0});
  std::ranges::stable_sort(by_speed_, {}, [&](std::size_t i) { return speed_[i]; });
  for (std::size_t g = 0; g < kSpeeds; ++g) {
    std::vector<double> magnitudes;
    for (const std::size_t i : rows_of_speed(g)) magnitudes.push_back(std::abs(deviation_[i]));
    const double sd = kMadToSd * median(magnitudes);
    middle_speed_.push_back(speed_[by_speed_[n * (2 * g + 1) / (2 * kSpeeds)]]);
    speed_level_.push_back(elementary::log(std::max(sd / robust_sd_, kLeastShare)));
  }
}

std::span<const std::size_t> BurstNoise::rows_of_speed(std::size_t group) const {
  const std::size_t n = by_speed_.size();
  const std::size_t first = n * group / kSpeeds;
  return std::span(by_speed_).subspan(first, n * (group + 1) / kSpeeds - first);
}

// The noise at the row's speed; between the middles of the groups its logarithm is straight.
void BurstNoise::scale_by_speed() {
  std::ranges::fill(unit_, robust_sd_);
  for (std::size_t i = 0; i < speed_.size(); ++i) {
    std::size_t g = 1;
    while (g + 1 < kSpeeds && speed_[i] > middle_speed_[g]) ++g;
    const double width = middle_speed_[g] - middle_speed_[g - 1];
    const double part =
        width > 0 ? std::clamp((speed_[i] - middle_speed_[g - 1]) / width, -0.5, 1.5) : 1;
    unit_[i] = robust_sd_ * elementary::exp(speed_level_[g - 1] +
                                            part * (speed_level_[g] - speed_level_[g - 1]));
  }
}

// The same again, from innovations and with the movements' own levels out of the way.
void BurstNoise::refine_speeds() {
  for (std::size_t g = 0; g < speed_level_.size(); ++g) {
    std::vector<double> z;
    for (const std::size_t i : rows_of_speed(g)) z.push_back(innovation_[i]);
    speed_level_[g] += elementary::log(std::max(level_of(z, law_, 1, kIterations), kLeastShare));
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
  const double sampling = (law_.freedom + 3) / (2 * law_.freedom * rows);
  const double kept = spread_ > 0 ? spread_ / (spread_ + sampling) : 0;
  return {elementary::exp(mean_log_level_ + kept * (elementary::log(own) - mean_log_level_)),
          kept * sampling};
}

// Of the logarithm of a speed's noise: its rows tell it, and the movements they are in.
double BurstNoise::variance_of_speed_levels() const {
  double sum = 0;
  for (std::size_t g = 0; g < speed_level_.size(); ++g) {
    std::vector<double> rows_of(movements_.size(), 0.0);
    const std::span<const std::size_t> rows = rows_of_speed(g);
    for (const std::size_t i : rows) ++rows_of[movement_at(i)];
    double squares = 0;
    for (const double n : rows_of) squares += n * n;
    const auto n = static_cast<double>(rows.size());
    sum += (law_.freedom + 3) / (2 * law_.freedom * n) + spread_ * squares / (n * n);
  }
  return speed_level_.empty() ? 0 : sum / static_cast<double>(speed_level_.size());
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
                 kIterations));
    mean_log_level_ += elementary::log(own.back()) / count;
    sampling += (law_.freedom + 3) / (2 * law_.freedom * rows) / count;
  }
  double spread = 0;
  for (const double x : own) {
    const double apart = elementary::log(x) - mean_log_level_;
    spread += apart * apart / std::max(1.0, count - 1);
  }
  spread_ = std::max(0.0, spread - sampling);
  for (std::size_t m = 0; m < movements_.size(); ++m) {
    const RowRange& range = movements_[m];
    level_[m] = shrunk_level(own[m], static_cast<double>(range.size())).factor;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      innovation_[i] /= level_[m];
      unit_[i] *= level_[m];
    }
  }
  const double before = law_.scale;
  law_ = fit_student(innovation_);
  mean_log_level_ += elementary::log(before / law_.scale);
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
