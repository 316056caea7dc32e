// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/events.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "algorithms/diagnosis/clusters.hpp"
#include "algorithms/diagnosis/student_law.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kMargin = 5;
// Rows beyond this share are no events: the model is wrong.
constexpr double kMostEvents = 0.05;
constexpr double kMadToSd = 1.4826;
constexpr double kLeastShare = 0.02;  // of the typical noise a row's noise is at least
constexpr std::size_t kSpeeds = 8;    // groups of equal size

// A pulse is a half sine (the standard form of a shock, IEC 60068-2-27), so many rows long and so
// many robust standard deviations of the residual high: the lowest is that of which four rows
// exceed four (specification, section 4); less is none, however well it stands out.
constexpr std::array<std::size_t, 4> kLengths = {4, 6, 9, 14};
constexpr std::array<double, 5> kHeights = {6, 9, 14, 28, 80};
constexpr std::size_t kLongestPulse = 15;  // rows it touches
// Only where four neighbouring innovations, clipped, add up to this is the ratio worked out.
constexpr double kClip = 4;
constexpr double kLeastSum = 7;
constexpr std::size_t kSumRows = 4;
constexpr std::size_t kDraws = 300;  // of the tail under the null

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), values.begin() + middle, values.end());
  return values[static_cast<std::size_t>(middle)];
}

double median_magnitude(std::vector<double> values) {
  for (double& x : values) x = std::abs(x);
  return median(std::move(values));
}

std::vector<RowRange> ranges_of(const Observations& data) {
  std::vector<RowRange> ranges;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (i == 0 || data.movement[i] != data.movement[i - 1]) ranges.push_back({i, i});
    ranges.back().end = i + 1;
  }
  return ranges;
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

class BurstScan {
 public:
  BurstScan(const Observations& data, const Eigen::VectorXd& residual)
      : ranges_(ranges_of(data)), deviation_(data.rows()), scale_(data.rows(), 1.0) {
    centre(residual);
    robust_sd_ = kMadToSd * median_magnitude(deviation_);
    if (!(robust_sd_ > 0)) return;
    scale_by_speed(data);
    innovate();
    scale_by_movement();
    law_ = fit_student(z_);
    make_pulses();
  }

  struct Burst {
    std::size_t begin;
    std::size_t end;
    double log_ratio;  // of the average
  };

  // The starts that no recording without bursts would show but once in 1 / kFalseBursts;
  // overlapping ones once.
  std::vector<Burst> find(RandomStream random) const {
    std::vector<Burst> starts;
    if (!(robust_sd_ > 0)) return starts;
    for (const RowRange& m : ranges_) {
      for (std::size_t i = m.begin; i < m.end; ++i) {
        if (!worth_a_look(i, m.end)) continue;
        const Burst burst = ratio_at(i, &z_[i], m.end, law_);
        if (burst.log_ratio > 0) starts.push_back(burst);
      }
    }
    if (starts.empty()) return starts;
    const double wanted = threshold(std::move(random));
    std::erase_if(starts, [&](const Burst& one) {
      return one.log_ratio < wanted || peak(one) < kHeights[0] * robust_sd_;
    });
    std::ranges::stable_sort(
        starts, [](const Burst& a, const Burst& b) { return a.log_ratio > b.log_ratio; });
    std::vector<Burst> found;
    for (const Burst& one : starts) {
      const bool known = std::ranges::any_of(found, [&](const Burst& other) {
        return one.begin < other.end + kMargin && other.begin < one.end + kMargin;
      });
      if (!known) found.push_back(one);
    }
    std::ranges::sort(found, {}, &Burst::begin);
    return found;
  }

  double peak(const Burst& burst) const {
    double most = 0;
    for (std::size_t i = burst.begin; i < burst.end; ++i) {
      most = std::max(most, std::abs(deviation_[i]));
    }
    return most;
  }

  const std::vector<RowRange>& ranges() const { return ranges_; }

 private:
  // From the movement's median, as far as offsets are more than what correlated noise makes of it.
  void centre(const Eigen::VectorXd& residual) {
    std::vector<double> middles;
    for (const RowRange& m : ranges_) {
      middles.push_back(
          median(std::vector<double>(residual.data() + m.begin, residual.data() + m.end)));
      for (std::size_t i = m.begin; i < m.end; ++i) {
        deviation_[i] = residual[static_cast<Eigen::Index>(i)] - middles.back();
      }
    }
    const double sd = kMadToSd * median_magnitude(deviation_);
    rho_ = neighbour_correlation(deviation_, ranges_, 3 * sd);
    double spread = 0;
    double sampling = 0;
    for (std::size_t m = 0; m < ranges_.size(); ++m) {
      const auto rows = static_cast<double>(ranges_[m].size());
      spread += middles[m] * middles[m];
      // Of a median of normal rows, correlated by rho.
      sampling += std::numbers::pi / 2 * sd * sd * std::min((1 + rho_) / (1 - rho_), rows) / rows;
    }
    const double shrunk = spread > 0 ? std::clamp(sampling / spread, 0.0, 1.0) : 0;
    for (std::size_t m = 0; m < ranges_.size(); ++m) {
      for (std::size_t i = ranges_[m].begin; i < ranges_[m].end; ++i) {
        deviation_[i] += shrunk * middles[m];
      }
    }
  }

  void innovate() {
    z_.resize(deviation_.size());
    for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = deviation_[i] / scale_[i];
    rho_ = neighbour_correlation(z_, ranges_, 3);
    for (const RowRange& m : ranges_) {
      for (std::size_t i = m.end; i-- > m.begin + 1;) z_[i] -= rho_ * z_[i - 1];
      z_[m.begin] *= std::sqrt(1 - rho_ * rho_);
    }
  }

  // The noise at the row's speed; between the middles of the groups its logarithm is straight.
  void scale_by_speed(const Observations& data) {
    const Signal* v = data.find("v");
    const std::size_t n = data.rows();
    std::ranges::fill(scale_, robust_sd_);
    if (v == nullptr || n < 4 * kSpeeds) return;
    std::vector<std::pair<double, double>> rows(n);  // speed, magnitude
    for (std::size_t i = 0; i < n; ++i) {
      rows[i] = {std::abs(v->values[i]), std::abs(deviation_[i])};
    }
    std::ranges::sort(rows, {}, &std::pair<double, double>::first);
    std::array<double, kSpeeds> middle{};
    std::array<double, kSpeeds> level{};
    for (std::size_t g = 0; g < kSpeeds; ++g) {
      std::vector<double> magnitudes;
      for (std::size_t i = n * g / kSpeeds; i < n * (g + 1) / kSpeeds; ++i) {
        magnitudes.push_back(rows[i].second);
      }
      middle[g] = rows[n * (2 * g + 1) / (2 * kSpeeds)].first;
      level[g] =
          std::log(std::max(kMadToSd * median(std::move(magnitudes)), kLeastShare * robust_sd_));
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double speed = std::abs(v->values[i]);
      std::size_t g = 1;
      while (g + 1 < kSpeeds && speed > middle[g]) ++g;
      const double width = middle[g] - middle[g - 1];
      const double part = width > 0 ? std::clamp((speed - middle[g - 1]) / width, -0.5, 1.5) : 1;
      scale_[i] = std::exp(level[g - 1] + part * (level[g] - level[g - 1]));
    }
  }

  // The movements' own noise, as far as their rows tell it from the others'.
  void scale_by_movement() {
    const auto count = static_cast<double>(ranges_.size());
    const double typical = std::max(median_magnitude(z_), 1e-9);
    std::vector<double> logs;
    double mean = 0;
    double sampling = 0;
    for (const RowRange& m : ranges_) {
      // Clipped, so that a burst does not hide in the noise it makes.
      const double limit = kClip * typical;
      double sum = 0;
      double squares = 0;
      for (std::size_t i = m.begin; i < m.end; ++i) {
        const double size = std::min(std::abs(z_[i]), limit);
        sum += size;
        squares += size * size;
      }
      const auto n = static_cast<double>(m.size());
      const double own = std::max(sum / n, kLeastShare * typical);
      logs.push_back(std::log(own));
      mean += logs.back() / count;
      sampling += std::max(0.0, squares / n - own * own) / (own * own) / n / count;
    }
    double spread = 0;
    for (const double x : logs) spread += (x - mean) * (x - mean) / std::max(1.0, count - 1);
    const double kept = spread > 0 ? std::clamp(1 - sampling / spread, 0.0, 1.0) : 0;
    scale_error_ = std::sqrt(kept * sampling);
    for (std::size_t m = 0; m < ranges_.size(); ++m) {
      const double own = std::exp(mean + kept * (logs[m] - mean));
      for (std::size_t i = ranges_[m].begin; i < ranges_[m].end; ++i) {
        z_[i] /= own;
        scale_[i] *= own;
      }
    }
  }

  // Half sines with a zero before and after.
  void make_pulses() {
    for (const std::size_t rows : kLengths) {
      std::vector<double> pulse;
      for (std::size_t k = 0; k < rows; ++k) {
        pulse.push_back(std::sin(std::numbers::pi * (static_cast<double>(k) + 0.5) /
                                 static_cast<double>(rows)));
      }
      pulse.push_back(0);
      pulses_.push_back(std::move(pulse));
    }
  }

  // What a pulse of unit height from row `first` on adds to the innovation k rows later.
  double added(const std::vector<double>& pulse, std::size_t first, std::size_t k) const {
    return pulse[k] / scale_[first + k] -
           (k > 0 ? rho_ * pulse[k - 1] / scale_[first + k - 1] : 0.0);
  }

  bool worth_a_look(std::size_t first, std::size_t end) const {
    double sum = 0;
    for (std::size_t i = first; i < std::min(first + kSumRows, end); ++i) {
      sum += std::clamp(z_[i], -kClip, kClip);
    }
    return std::abs(sum) >= kLeastSum;
  }

  // Of the innovations z as if they stood from row `first` on; rows from `end` on are another
  // movement's.
  Burst ratio_at(std::size_t first, const double* z, std::size_t end, const StudentLaw& law) const {
    const std::size_t reach = std::min(kLongestPulse, end - first);
    std::array<double, kLongestPulse> null{};
    double towards = 0;
    for (std::size_t k = 0; k < reach; ++k) {
      null[k] = 1 / law.kernel(z[k]);
      if (k < kSumRows) towards += z[k];
    }
    const double side = towards > 0 ? robust_sd_ : -robust_sd_;
    Burst burst{first, first + 1, 0};
    double best = -1;
    double sum = 0;
    for (const std::vector<double>& pulse : pulses_) {
      const std::size_t rows = std::min(pulse.size(), reach);
      std::array<double, kLongestPulse> unit{};
      for (std::size_t k = 0; k < rows; ++k) unit[k] = side * added(pulse, first, k);
      for (const double height : kHeights) {
        double kernels = 1;
        for (std::size_t k = 0; k < rows; ++k) {
          kernels *= law.kernel(z[k] - height * unit[k]) * null[k];
        }
        const double ratio = std::pow(kernels, -0.5 * (law.freedom + 1));
        sum += std::min(ratio, 1e250);
        if (ratio > best) {
          best = ratio;
          burst.end = std::min(first + pulse.size() - 1, end);
        }
      }
    }
    // Half the weight is the other side's, whose ratios are next to nothing.
    burst.log_ratio = std::log(sum / (2.0 * static_cast<double>(pulses_.size() * kHeights.size())));
    return burst;
  }

  // The log ratio that all rows together exceed with probability kFalseBursts at most. The tail of
  // one start under the null is the mean of 1 / ratio over draws with a pulse there (importance
  // sampling), and rows add up. Of neighbouring starts only the likeliest counts.
  double threshold(RandomStream random) const {
    struct Draw {
      double taken;  // the ratio under the law as it is taken for
      double ratio;  // and as it is: a movement's noise is not known exactly
    };
    std::vector<Draw> draws;
    for (std::size_t d = 0; d < kDraws; ++d) {
      const std::size_t first = random.below(z_.size());
      const RowRange& m = *std::prev(
          std::ranges::upper_bound(ranges_, first, std::ranges::less(), &RowRange::begin));
      const std::vector<double>& pulse = pulses_[random.below(pulses_.size())];
      const double height = random.sign() * robust_sd_ * kHeights[random.below(kHeights.size())];
      const StudentLaw own{law_.freedom, law_.scale * std::exp(scale_error_ * random.normal())};
      const std::size_t from = std::max(m.begin + 1, first) - 1;
      std::array<double, kLongestPulse + 2> z{};  // from row `from` on
      for (std::size_t i = from; i < std::min(m.end, first + kLongestPulse + 1); ++i) {
        z[i - from] = own.draw(random);
        const bool inside = i >= first && i < first + pulse.size();
        if (inside) z[i - from] += height * added(pulse, first, i - first);
      }
      const auto ratio = [&](std::size_t start, const StudentLaw& law) {
        return ratio_at(start, &z[start - from], m.end, law).log_ratio;
      };
      const double taken = ratio(first, law_);
      const bool before = first > from && ratio(first - 1, law_) > taken;
      const bool after = first + 1 < m.end && ratio(first + 1, law_) > taken;
      if (!before && !after) draws.push_back({taken, ratio(first, own)});
    }
    std::ranges::sort(draws, std::greater<>(), &Draw::taken);
    // Downwards from the largest: the sum of 1 / ratio beyond each.
    const double each = static_cast<double>(z_.size()) / static_cast<double>(kDraws);
    double expected = 0;
    for (const Draw& draw : draws) {
      expected += each * std::exp(-draw.ratio);
      if (expected > kFalseBursts) return draw.taken;
    }
    return 0;
  }

  std::vector<RowRange> ranges_;
  std::vector<double> deviation_;  // from the movement's offset
  std::vector<double> z_;          // innovations in units of their own noise
  std::vector<double> scale_;      // that noise
  double robust_sd_ = 0;
  double rho_ = 0;
  double scale_error_ = 0;  // sd of the logarithm of a movement's noise, given its rows
  StudentLaw law_;
  std::vector<std::vector<double>> pulses_;  // one row of zero at the end
};

}  // namespace

std::vector<EventFinding> find_events(const Observations& data, const Eigen::VectorXd& residual,
                                      std::vector<char>& masked, RandomStream random) {
  masked.assign(data.rows(), 0);
  const BurstScan scan(data, residual);
  std::vector<EventFinding> events;
  std::size_t flagged = 0;
  for (const BurstScan::Burst& burst : scan.find(random)) {
    const int movement = data.movement[burst.begin];
    events.push_back({movement,
                      data.movement_names.empty()
                          ? std::to_string(movement)
                          : data.movement_names[static_cast<std::size_t>(movement)],
                      data.time[burst.begin], data.time[burst.end - 1], scan.peak(burst)});
    flagged += burst.end - burst.begin;
    const RowRange& m = *std::ranges::find_if(
        scan.ranges(), [&](const RowRange& range) { return burst.begin < range.end; });
    const std::size_t from = std::max(m.begin + kMargin, burst.begin) - kMargin;
    for (std::size_t i = from; i < std::min(m.end, burst.end + kMargin); ++i) masked[i] = 1;
  }
  if (static_cast<double>(flagged) > kMostEvents * static_cast<double>(data.rows())) {
    events.clear();
    masked.assign(data.rows(), 0);
  }
  return events;
}

}  // namespace tribench::loop
