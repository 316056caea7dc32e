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

  double at(double t) const {
    constexpr double kNoTime = 1e-9;  // of the times' squares
    const double spread = tt_ - t_ * t_ / n_;
    const double mean = y_ / n_;
    if (!(spread > kNoTime * tt_)) return mean;
    return mean + (ty_ - t_ * y_ / n_) / spread * (t - t_ / n_);
  }

 private:
  double n_ = 0;
  double t_ = 0;
  double y_ = 0;
  double tt_ = 0;
  double ty_ = 0;
};

// One movement.
void smooth(std::span<const double> values, std::span<const double> time, std::span<double> out) {
  LineWindow window;
  std::size_t first = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (; end < values.size() && time[end] - time[i] <= kThermalSeconds / 2; ++end) {
      window.add(time[end] - time[0], values[end] - values[0], 1);
    }
    for (; time[i] - time[first] > kThermalSeconds / 2; ++first) {
      window.add(time[first] - time[0], values[first] - values[0], -1);
    }
    out[i] = values[0] + window.at(time[i] - time[0]);
  }
}

}  // namespace

std::vector<double> slow_temperature(std::span<const double> values, std::span<const double> time,
                                     std::span<const int> movement) {
  std::vector<double> out(values.begin(), values.end());
  for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
    while (end < values.size() && movement[end] == movement[begin]) ++end;
    const std::size_t count = end - begin;
    const std::span<const double> own_time = time.subspan(begin, count);
    if (!std::ranges::is_sorted(own_time)) continue;
    smooth(values.subspan(begin, count), own_time, std::span(out).subspan(begin, count));
  }
  return out;
}

}  // namespace tribench::loop
