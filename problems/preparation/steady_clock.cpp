// SPDX-License-Identifier: MIT
#include "problems/preparation/steady_clock.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewestRows = 50;  // of a piece
constexpr double kEven = 0.005;          // of a step: so little jitter matters nowhere
constexpr double kFar = 0.5;             // of a step, root mean square: no steady clock
constexpr double kBend = 1;              // s over which a clock is straight

// The beat: the mean of the steps about the usual one, those over lost rows left out.
double beat_of(std::span<const double> time, std::span<const RowRange> pieces) {
  constexpr int kRounds = 4;
  std::vector<double> steps;
  for (const RowRange& piece : pieces) {
    for (std::size_t i = piece.begin + 1; i < piece.end; ++i) {
      steps.push_back(time[i] - time[i - 1]);
    }
  }
  double beat = upper_median(steps);
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0;
    double count = 0;
    for (const double step : steps) {
      if (step < 0.5 * beat || step > 1.5 * beat) continue;
      sum += step;
      ++count;
    }
    if (count > 0) beat = sum / count;
  }
  return beat;
}

// The one of the first stamps that lies in the middle of them, on the circle of a beat.
double first_beat(std::span<const double> time, double beat) {
  constexpr std::size_t kRows = 25;
  const std::span<const double> first = time.first(std::min(kRows, time.size()));
  const auto distance = [&](double candidate) {
    double sum = 0;
    for (const double stamp : first) {
      const double beats = (stamp - candidate) / beat;
      sum += std::abs(beats - std::round(beats));
    }
    return sum;
  };
  return *std::ranges::min_element(first, {}, distance);
}

// The number of each row's sample, those that no row holds counted too: the nearest beat of a
// clock that follows the stamps in phase and frequency. A message can only be late: where two
// would have one number the earlier was.
std::vector<double> sample_numbers(std::span<const double> time, double beat) {
  constexpr double kFollow = 0.05;
  double phase = first_beat(time, beat);  // of the last number
  double last = 0;
  std::vector<double> number;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double now = std::round((time[i] - phase) / beat);
    const double off = time[i] - phase - now * beat;
    number.push_back(last + now);
    // Counted from here on, so that a change of the beat moves nothing that is past.
    phase += now * beat + kFollow * off;
    beat += 0.25 * kFollow * kFollow * off;
    last = number.back();
    for (std::size_t k = i; k > 0 && number[k - 1] >= number[k]; --k) {
      number[k - 1] = number[k] - 1;
    }
  }
  return number;
}

// What is left of the stamps on a line over the samples' numbers; the line takes their place.
std::vector<double> take_line_off(std::span<const double> time, std::vector<double>& number) {
  const auto n = static_cast<double>(time.size());
  double mean_number = 0;
  double mean_time = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    mean_number += number[i] / n;
    mean_time += (time[i] - time[0]) / n;
  }
  double squares = 0;
  double products = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    squares += (number[i] - mean_number) * (number[i] - mean_number);
    products += (number[i] - mean_number) * (time[i] - time[0] - mean_time);
  }
  std::vector<double> rest;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double on_line = mean_time + products / squares * (number[i] - mean_number);
    rest.push_back(time[i] - time[0] - on_line);
    number[i] = time[0] + on_line;
  }
  return rest;
}

// Means over `reach` rows to either side, fewer at the ends.
std::vector<double> running_means(const std::vector<double>& values, std::size_t reach) {
  std::vector<double> until = {0};
  for (const double value : values) until.push_back(until.back() + value);
  std::vector<double> means;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t side = std::min({reach, i, values.size() - 1 - i});
    means.push_back((until[i + side + 1] - until[i - side]) / static_cast<double>(2 * side + 1));
  }
  return means;
}

}  // namespace

std::optional<SteadyClock> steady_clock(std::span<const double> time,
                                        std::span<const RowRange> pieces) {
  const double step = beat_of(time, pieces);
  if (!(step > 0)) return {};
  SteadyClock clock{{time.begin(), time.end()}, 0};
  const auto reach = static_cast<std::size_t>(std::max(0.5 * kBend / step, 25.0));
  double squares = 0;
  double rows = 0;
  for (const RowRange& piece : pieces) {
    const std::size_t n = piece.end - piece.begin;
    if (n < kFewestRows) continue;
    const std::span<const double> stamps = time.subspan(piece.begin, n);
    std::vector<double> steady = sample_numbers(stamps, step);
    const std::vector<double> rest = take_line_off(stamps, steady);
    const std::vector<double> bend = running_means(rest, reach);
    for (std::size_t i = 0; i < n; ++i) {
      clock.time[piece.begin + i] = steady[i] + bend[i];
      squares += (rest[i] - bend[i]) * (rest[i] - bend[i]);
    }
    rows += static_cast<double>(n);
    for (std::size_t i = piece.begin + 1; i < piece.end; ++i) {
      if (clock.time[i] <= clock.time[i - 1]) return {};
    }
  }
  if (rows == 0) return {};
  clock.jitter = std::sqrt(squares / rows);
  if (clock.jitter < kEven * step || clock.jitter > kFar * step) return {};
  return clock;
}

}  // namespace tribench
