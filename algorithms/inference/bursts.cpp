// SPDX-License-Identifier: MIT
#include "algorithms/inference/bursts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

#include "algorithms/inference/burst_likelihood.hpp"
#include "algorithms/inference/burst_noise.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kMargin = 5;
// Rows beyond this share are no bursts: the model is wrong.
constexpr double kMostRows = 0.05;

// A pulse is a half sine (the standard form of a shock, IEC 60068-2-27), so many rows long and so
// many robust standard deviations of the residual high: the lowest is that of which four rows
// exceed four (specification, section 4); less is none, however well it stands out.
constexpr std::array<std::size_t, 4> kLengths = {4, 6, 9, 14};
constexpr std::array<double, 5> kHeights = {6, 9, 14, 28, 80};
// Likely pulses in a recording from which on one has to stand out of the others.
constexpr std::size_t kFewestForTail = 8;
// A start counts only where four neighbouring innovations, clipped, add up to this: no single row
// and no slow drift passes for a pulse.
constexpr double kClip = 4;
constexpr double kLeastSum = 7;
constexpr std::size_t kSumRows = 4;
// Of the tail under the null: with pulses of the lowest heights, whose ratios come near the
// threshold.
constexpr std::size_t kDraws = 512;
constexpr std::size_t kDrawnHeights = 2;

class BurstScan {
 public:
  BurstScan(std::span<const int> movement, std::span<const double> speed,
            const Eigen::VectorXd& residual)
      : movement_(movement), noise_(movement, speed, residual) {
    make_pulses();
  }

  // The starts that no recording without bursts would show but once in 1 / kFalseBursts;
  // overlapping ones once.
  std::vector<Burst> find(RandomStream random) {
    if (!(noise_.robust_sd() > 0)) return {};
    std::vector<Burst> separate = likely_pulses();
    if (separate.empty()) return {};
    loud_ = share_of_loud_spells(noise_, rows_about(separate, movement_));
    if (loud_ > 0) separate = likely_pulses();
    const double wanted = std::max(threshold(random), stands_out_of(separate));
    std::vector<Burst> found;
    for (Burst one : separate) {
      one.peak = peak(one);
      if (one.log_ratio >= wanted && one.peak >= kHeights[0] * noise_.robust_sd()) {
        found.push_back(one);
      }
    }
    std::ranges::sort(found, {}, &Burst::begin);
    return found;
  }

 private:
  std::vector<Burst> likely_pulses() const {
    std::vector<Burst> starts;
    for (std::size_t m = 0; m < noise_.movements().size(); ++m) {
      const RowRange& range = noise_.movements()[m];
      for (std::size_t i = range.begin; i < range.end; ++i) {
        if (!rises(&noise_.innovation()[i], range.end - i)) continue;
        const Burst burst = burst_at(m, i);
        if (burst.log_ratio > 0) starts.push_back(burst);
      }
    }
    return likeliest_of_overlapping(std::move(starts));
  }

  double peak(const Burst& burst) const {
    double most = 0;
    for (std::size_t i = burst.begin; i < burst.end; ++i) {
      most = std::max(most, std::abs(noise_.deviation()[i]));
    }
    return most;
  }

  // Overlapping starts once; the likeliest first.
  static std::vector<Burst> likeliest_of_overlapping(std::vector<Burst> starts) {
    std::ranges::stable_sort(
        starts, [](const Burst& a, const Burst& b) { return a.log_ratio > b.log_ratio; });
    std::vector<Burst> separate;
    for (const Burst& one : starts) {
      const bool known = std::ranges::any_of(separate, [&](const Burst& other) {
        return one.begin < other.end + kMargin && other.begin < one.end + kMargin;
      });
      if (!known) separate.push_back(one);
    }
    return separate;
  }

  // The log ratio at which one stands out of the others of the recording, whatever its noise is: of
  // an exponential tail with the median of theirs (Pickands 1975, with a shape of 0). A few bursts
  // do not move it; noise that comes in loud spells has many.
  static double stands_out_of(const std::vector<Burst>& separate) {
    if (separate.size() < kFewestForTail) return 0;
    const double median = separate[separate.size() / 2].log_ratio;
    return median / std::numbers::ln2 *
           elementary::log(static_cast<double>(separate.size()) / kFalseBursts);
  }

  // Half sines with a zero after.
  void make_pulses() {
    for (const std::size_t rows : kLengths) {
      std::vector<double> pulse;
      for (std::size_t k = 0; k < rows; ++k) {
        pulse.push_back(elementary::sin(std::numbers::pi * (static_cast<double>(k) + 0.5) /
                                        static_cast<double>(rows)));
      }
      pulse.push_back(0);
      pulses_.push_back(std::move(pulse));
    }
  }

  // What a pulse of unit height from row `first` on adds to the innovation k rows later.
  double added(const std::vector<double>& pulse, std::size_t first, std::size_t k) const {
    const std::vector<double>& unit = noise_.unit();
    return pulse[k] / unit[first + k] -
           (k > 0 ? noise_.rho() * pulse[k - 1] / unit[first + k - 1] : 0.0);
  }

  static bool rises(const double* z, std::size_t rows) {
    double sum = 0;
    for (std::size_t k = 0; k < std::min(kSumRows, rows); ++k) {
      sum += std::clamp(z[k], -kClip, kClip);
    }
    return std::abs(sum) >= kLeastSum;
  }

  // How much likelier pulses make the innovations z, as if they stood from row `first` on.
  struct Ratios {
    double all = 0;             // log of the average
    double drawn = 0;           // ... over the heights that are drawn for the threshold
    std::size_t likeliest = 0;  // pulse
  };
  // Ratios of likelihoods, summed over pulses and heights; the largest, and whose it is.
  struct RatioSums {
    double all = 0;
    double drawn = 0;
    double largest = -1;
    std::size_t likeliest = 0;  // pulse
  };

  // By least squares.
  static double fitted_height(const double* z, const double* unit, std::size_t rows) {
    double product = 0;
    double square = 0;
    for (std::size_t k = 0; k < rows; ++k) {
      product += z[k] * unit[k];
      square += unit[k] * unit[k];
    }
    return product / square;
  }

  // Pulse p, its heights in units of `side`, on `rows` rows from `first` on.
  void add_ratios(std::size_t p, std::size_t first, std::size_t rows, double side, const double* z,
                  const NoiseLevels& levels, RatioSums& sums) const {
    std::array<double, kLongestPulse> unit{};
    std::array<double, kLongestPulse> kernels{};
    for (std::size_t k = 0; k < rows; ++k) {
      unit[k] = side * added(pulses_[p], first, k);
      kernels[k] = 1 / noise_.law().kernel(z[k]);
    }
    const auto of_height = [&](double height) {
      return pulse_likelihood(noise_.law(), z, unit.data(), height, rows, levels, kernels.data());
    };
    const double null =
        quiet_likelihood(noise_.law(), z, rows, levels, kernels.data()).mixed(loud_);
    const auto add = [&](double height, bool is_drawn) {
      const double ratio = std::min(of_height(height) / null, 1e250);
      sums.all += ratio;
      if (is_drawn) sums.drawn += ratio;
      if (ratio <= sums.largest) return;
      sums.largest = ratio;
      sums.likeliest = p;
    };
    for (std::size_t h = 0; h < kHeights.size(); ++h) add(kHeights[h], h < kDrawnHeights);
    add(std::max(kHeights[0], fitted_height(z, unit.data(), rows)), false);
  }

  // Rows from `end` on are another movement's; levels: the noise, a pulse, with its rows left out.
  Ratios ratios_at(std::size_t first, const double* z, std::size_t end,
                   std::span<const NoiseLevels> levels) const {
    const std::size_t reach = std::min(kLongestPulse, end - first);
    double towards = 0;
    for (std::size_t k = 0; k < std::min(reach, kSumRows); ++k) towards += z[k];
    const double side = towards > 0 ? noise_.robust_sd() : -noise_.robust_sd();
    RatioSums sums;
    for (std::size_t p = 0; p < pulses_.size(); ++p) {
      add_ratios(p, first, std::min(pulses_[p].size(), reach), side, z, levels[p], sums);
    }
    // Half the weight is the other side's, whose ratios are next to nothing.
    const auto pulses = static_cast<double>(pulses_.size());
    return {elementary::log(sums.all / (2 * pulses * static_cast<double>(kHeights.size() + 1))),
            elementary::log(sums.drawn / (2 * pulses * static_cast<double>(kDrawnHeights))),
            sums.likeliest};
  }

  Burst burst_at(std::size_t movement, std::size_t first) const {
    const std::size_t end = noise_.movements()[movement].end;
    std::vector<NoiseLevels> levels;
    for (const std::vector<double>& pulse : pulses_) {
      const std::size_t rows = std::min(pulse.size(), end - first);
      levels.emplace_back(noise_.level_without(movement, first, rows),
                          noise_.level_error(movement, rows));
    }
    const Ratios ratios = ratios_at(first, &noise_.innovation()[first], end, levels);
    return {first, std::min(first + kLengths[ratios.likeliest], end), 0, ratios.all};
  }

  // One recording of a pulse, drawn: what there is to see from a row before it on.
  struct Draw {
    std::size_t first;
    std::size_t from;
    std::size_t end;
    std::array<double, kLongestPulse + 2> z;
    std::vector<NoiseLevels> levels;
    Ratios ratios;
  };

  Draw draw(std::size_t number, RandomStream& random) const {
    const std::size_t rows = noise_.innovation().size();
    Draw out{};
    // Spread evenly over the rows, the pulses and the heights.
    out.first = (rows * number + random.below(rows)) / kDraws;
    const std::size_t movement = noise_.movement_at(out.first);
    const RowRange& range = noise_.movements()[movement];
    const std::size_t drawn = number % pulses_.size();
    const std::vector<double>& pulse = pulses_[drawn];
    for (const std::vector<double>& one : pulses_) {
      out.levels.emplace_back(1, noise_.level_error(movement, one.size()));
    }
    const double height = random.sign() * noise_.law().wider_side() * noise_.robust_sd() *
                          kHeights[number / pulses_.size() % kDrawnHeights];
    const StudentLaw own = noise_.law().times(out.levels[drawn].draw(random));
    out.from = std::max(range.begin + 1, out.first) - 1;
    out.end = range.end;
    for (std::size_t i = out.from; i < std::min(out.end, out.first + kLongestPulse + 1); ++i) {
      out.z[i - out.from] = own.draw(random);
      const bool inside = i >= out.first && i < out.first + pulse.size();
      if (inside) out.z[i - out.from] += height * added(pulse, out.first, i - out.first);
    }
    return out;
  }

  Ratios ratios_of(const Draw& draw, std::size_t first) const {
    return ratios_at(first, &draw.z[first - draw.from], draw.end, draw.levels);
  }

  // Whether a neighbouring start would be taken in its place.
  bool gives_way(const Draw& draw, std::size_t to) const {
    return rises(&draw.z[to - draw.from], draw.end - to) &&
           ratios_of(draw, to).all > draw.ratios.all;
  }

  // The log ratio that all rows together exceed with probability kFalseBursts at most. The tail of
  // one start under the null is the mean of 1 / ratio over draws with a pulse there (importance
  // sampling), and rows add up. Of neighbouring starts only the likeliest counts.
  double threshold(RandomStream random) const {
    std::vector<Draw> draws;
    for (std::size_t d = 0; d < kDraws; ++d) {
      Draw one = draw(d, random);
      if (!rises(&one.z[one.first - one.from], one.end - one.first)) continue;
      one.ratios = ratios_of(one, one.first);
      draws.push_back(std::move(one));
    }
    std::ranges::stable_sort(draws, std::greater<>(),
                             [](const Draw& one) { return one.ratios.all; });
    // Downwards from the largest: the sum of 1 / ratio beyond each.
    const double each =
        static_cast<double>(noise_.innovation().size()) / static_cast<double>(kDraws);
    double expected = 0;
    for (const Draw& one : draws) {
      if (one.first > one.from && gives_way(one, one.first - 1)) continue;
      if (one.first + 1 < one.end && gives_way(one, one.first + 1)) continue;
      expected += each * elementary::exp(-one.ratios.drawn);
      if (expected > kFalseBursts) return one.ratios.all;
    }
    return 0;
  }

  std::span<const int> movement_;
  BurstNoise noise_;
  std::vector<std::vector<double>> pulses_;  // one row of zero at the end
  double loud_ = 0;                          // share of rows in loud spells
};

}  // namespace

std::vector<Burst> find_bursts(std::span<const int> movement, std::span<const double> speed,
                               const Eigen::VectorXd& residual, RandomStream random) {
  std::vector<Burst> bursts = BurstScan(movement, speed, residual).find(random);
  std::size_t rows = 0;
  for (const Burst& burst : bursts) rows += burst.end - burst.begin;
  if (static_cast<double>(rows) > kMostRows * static_cast<double>(movement.size())) bursts.clear();
  return bursts;
}

std::vector<char> rows_about(std::span<const Burst> bursts, std::span<const int> movement) {
  std::vector<char> about(movement.size(), 0);
  for (const Burst& burst : bursts) {
    const std::size_t first = burst.begin - std::min(kMargin, burst.begin);
    const std::size_t last = std::min(movement.size(), burst.end + kMargin);
    for (std::size_t i = first; i < last; ++i) {
      if (movement[i] == movement[burst.begin]) about[i] = 1;
    }
  }
  return about;
}

}  // namespace tribench::loop
