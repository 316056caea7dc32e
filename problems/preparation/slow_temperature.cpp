// SPDX-License-Identifier: MIT
#include "problems/preparation/slow_temperature.hpp"

#include <algorithm>
#include <cstddef>

namespace tribench::loop {
namespace {

// Sums over a window of rows that moves on; times and values count from one row's, so that equal
// readings stay what they are.
class LineWindow {
 public:
  void add(double t, double y, double weight) {
    n_ += weight;
    t_ += weight * t;
    y_ += weight * y;
    tt_ += weight * t * t;
    ty_ += weight * t * y;
  }

  double slope() const {
    constexpr double kNoTime = 1e-9;  // of the times' squares
    const double spread = tt_ - t_ * t_ / n_;
    return spread > kNoTime * tt_ ? (ty_ - t_ * y_ / n_) / spread : 0;
  }

  double at(double t) const { return y_ / n_ + slope() * (t - t_ / n_); }

 private:
  double n_ = 0;
  double t_ = 0;
  double y_ = 0;
  double tt_ = 0;
  double ty_ = 0;
};

// Rows in the order of time, a line through those near each.
class MovingLine {
 public:
  MovingLine(std::span<const double> values, std::span<const double> time, double seconds)
      : values_(values), time_(time), seconds_(seconds) {}

  // Rows one after the other.
  const LineWindow& around(std::size_t i) {
    for (; end_ < time_.size() && time_[end_] - time_[i] <= seconds_ / 2; ++end_) add(end_, 1);
    for (; time_[i] - time_[first_] > seconds_ / 2; ++first_) add(first_, -1);
    return window_;
  }

 private:
  void add(std::size_t i, double weight) {
    window_.add(time_[i] - time_[0], values_[i] - values_[0], weight);
  }

  std::span<const double> values_;
  std::span<const double> time_;
  double seconds_;
  LineWindow window_;
  std::size_t first_ = 0;
  std::size_t end_ = 0;
};

// Begin and end of the rows of each movement.
template <typename Take>
void for_each_movement(std::span<const int> movement, Take take) {
  for (std::size_t begin = 0, end = 0; begin < movement.size(); begin = end) {
    while (end < movement.size() && movement[end] == movement[begin]) ++end;
    take(begin, end);
  }
}

}  // namespace

std::vector<double> slow_temperature(std::span<const double> values, std::span<const double> time,
                                     std::span<const int> movement) {
  std::vector<double> out(values.begin(), values.end());
  for_each_movement(movement, [&](std::size_t begin, std::size_t end) {
    const std::span<const double> own_time = time.subspan(begin, end - begin);
    if (!std::ranges::is_sorted(own_time)) return;
    MovingLine line(values.subspan(begin, end - begin), own_time, kThermalSeconds);
    for (std::size_t i = begin; i < end; ++i) {
      out[i] = values[begin] + line.around(i - begin).at(time[i] - time[begin]);
    }
  });
  return out;
}

std::vector<double> temperature_rate(std::span<const double> values, std::span<const double> time,
                                     std::span<const int> movement, EarlierMovements earlier) {
  std::vector<double> out(values.size(), 0);
  for_each_movement(movement, [&](std::size_t begin, std::size_t end) {
    if (!std::ranges::is_sorted(time.subspan(begin, end - begin))) return;
    std::size_t first = begin;
    const auto runs_on = [&] {
      return time[first - 1] <= time[first] && time[begin] - time[first - 1] <= kWarmingSeconds / 2;
    };
    while (earlier == EarlierMovements::remembered && first > 0 && runs_on()) --first;
    MovingLine line(values.subspan(first, end - first), time.subspan(first, end - first),
                    kWarmingSeconds);
    for (std::size_t i = begin; i < end; ++i) out[i] = line.around(i - first).slope();
  });
  return out;
}

}  // namespace tribench::loop
