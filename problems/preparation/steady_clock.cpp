// SPDX-License-Identifier: MIT
#include "problems/preparation/steady_clock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewestRowsOfPiece = 50;
constexpr double kEven = 0.005;  // of a step: so little jitter matters nowhere
constexpr double kFar = 0.5;     // of a step, root mean square: no steady clock
constexpr double kBend = 1;      // s over which a clock is straight

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

double turns_of(double cosine, double sine) {  // -1/2 to 1/2
  const double size = std::sqrt(cosine * cosine + sine * sine);
  const double half = size > 0 ? elementary::atan(sine / (size + std::abs(cosine))) : 0;
  const double turns = half / std::numbers::pi;
  return cosine >= 0 ? turns : std::copysign(0.5, sine) - turns;
}

// Where the stamps lie within a beat, in beats: the circular mean over `reach` rows to either side,
// which no wrong count can mislead, laid end to end.
std::vector<double> phases(std::span<const double> beats, std::size_t reach) {
  std::vector<double> cosines;
  std::vector<double> sines;
  for (const double b : beats) {
    const double angle = 2 * std::numbers::pi * (b - std::floor(b));
    cosines.push_back(elementary::cos(angle));
    sines.push_back(elementary::sin(angle));
  }
  cosines = running_means(cosines, reach);
  sines = running_means(sines, reach);
  std::vector<double> phase;
  for (std::size_t i = 0; i < beats.size(); ++i) {
    const double here = turns_of(cosines[i], sines[i]);
    phase.push_back(i == 0 ? here : here + std::round(phase.back() - here));
  }
  return phase;
}

// The number of each row's sample, those that no row holds counted too: of all that rise from row
// to row the nearest to the stamps, by the sum of squares (Viterbi 1967). A message comes late by
// many samples where a bus was blocked. Empty: one was later than that.
std::vector<double> nearest_rising(std::span<const double> beats) {
  constexpr int kLatest = 30;  // samples
  constexpr int kChoices = kLatest + 2;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::vector<std::array<std::uint8_t, kChoices>> came_from(beats.size());
  std::array<double, kChoices> cost{};
  const auto number = [&](std::size_t i, int choice) {
    return std::round(beats[i]) + static_cast<double>(choice - kLatest);
  };
  for (std::size_t i = 0; i < beats.size(); ++i) {
    std::array<double, kChoices> next{};
    int before = 0;
    double least = i == 0 ? 0 : kNever;
    int from = 0;
    for (int c = 0; c < kChoices; ++c) {
      for (; i > 0 && before < kChoices && number(i - 1, before) < number(i, c); ++before) {
        if (cost[before] < least) {
          least = cost[before];
          from = before;
        }
      }
      const double off = beats[i] - number(i, c);
      next[c] = least + off * off;
      came_from[i][c] = static_cast<std::uint8_t>(from);
    }
    cost = next;
  }
  auto choice = static_cast<int>(std::ranges::min_element(cost) - cost.begin());
  std::vector<double> numbers(beats.size());
  if (cost[choice] == kNever) return {};
  for (std::size_t i = beats.size(); i-- > 0;) {
    numbers[i] = number(i, choice);
    choice = came_from[i][choice];
  }
  return numbers;
}

std::vector<double> in_beats(std::span<const double> time, double beat) {
  std::vector<double> beats;
  for (const double t : time) beats.push_back((t - time.front()) / beat);
  return beats;
}

// Empty: there is no steady clock behind the stamps. reach: rows over which it is straight.
std::vector<double> sample_numbers(std::span<const double> time, double beat, std::size_t reach) {
  constexpr std::size_t kFirstReach = 25;  // the beat is not known to much more rows than that
  if (!(time.back() > time.front())) return {};
  std::vector<double> beats = in_beats(time, beat);
  const std::vector<double> drift = phases(beats, kFirstReach);
  beats = in_beats(time, beat * (1 + (drift.back() - drift.front()) / beats.back()));
  const std::vector<double> phase = phases(beats, reach);
  for (std::size_t i = 0; i < beats.size(); ++i) beats[i] -= phase[i];
  return nearest_rising(beats);
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
    if (n < kFewestRowsOfPiece) continue;
    const std::span<const double> stamps = time.subspan(piece.begin, n);
    std::vector<double> steady = sample_numbers(stamps, step, reach);
    if (steady.empty()) return {};
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
