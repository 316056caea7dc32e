// SPDX-License-Identifier: MIT
#include "problems/preparation/segments.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

constexpr double kGap = 5;            // steps of time
constexpr double kLongestStep = 0.1;  // s: slower rows do not follow a motion
constexpr double kUneven = 3.5;       // usual steps: two rows in a row are lost at most
constexpr double kJump = 2.5;         // usual steps of the position
constexpr std::size_t kRepeats = 5;   // rows
constexpr double kStuckWay = 0.25;    // usual steps of the position a row: less is its noise
constexpr std::size_t kFewestAtLimit = 5;
constexpr std::size_t kMoreThanNext = 3;  // times the rows on the value beside it
constexpr double kRestWindow = 0.05;      // s over which a speed is averaged
constexpr std::size_t kRestWindows = 3;   // in a row: shorter ones are reversals
constexpr double kRestSpeed = 0.002;      // of the top speed
constexpr double kNoises = 3;
// Of a time: to the last digit it hangs on where the clock begins.
constexpr double kRounding = 1e-3;

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

std::vector<double> steps_of(std::span<const double> time, std::span<const int> movement) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (movement[i] == movement[i - 1] && time[i] > time[i - 1]) {
      steps.push_back(time[i] - time[i - 1]);
    }
  }
  return steps;
}

// Rows in stretches that get nowhere.
std::vector<char> resting_rows(std::span<const double> time, std::span<const double> velocity,
                               std::span<const RowRange> pieces, double slowest) {
  std::vector<char> rests(velocity.size(), 0);
  for (const RowRange& piece : pieces) {
    std::vector<RowRange> still;
    for (std::size_t begin = piece.begin; begin < piece.end;) {
      std::size_t end = begin;
      double sum = 0;
      while (end < piece.end && time[end] - time[begin] < (1 - kRounding) * kRestWindow) {
        sum += velocity[end++];
      }
      if (end == begin) sum = velocity[end++];
      const bool rest = std::abs(sum) < slowest * static_cast<double>(end - begin);
      if (rest) still.push_back({begin, end});
      begin = end;
    }
    for (std::size_t k = 0; k < still.size();) {
      std::size_t last = k;
      while (last + 1 < still.size() && still[last + 1].begin == still[last].end) ++last;
      if (last - k + 1 >= kRestWindows) {
        // The windows' ends are not the rest's: it lasts for as long as the rows are slow.
        std::size_t begin = still[k].begin;
        std::size_t end = still[last].end;
        while (begin > piece.begin && std::abs(velocity[begin - 1]) < slowest) --begin;
        while (end < piece.end && std::abs(velocity[end]) < slowest) ++end;
        std::fill(rests.begin() + static_cast<std::ptrdiff_t>(begin),
                  rests.begin() + static_cast<std::ptrdiff_t>(end), 1);
      }
      k = last + 1;
    }
  }
  return rests;
}

// Of a channel from row to row, where it changes.
double usual_change(std::span<const double> values, std::span<const int> movement) {
  std::vector<double> changes;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (movement[i] != movement[i - 1] || values[i] == values[i - 1]) continue;
    changes.push_back(std::abs(values[i] - values[i - 1]));
  }
  return upper_median(std::move(changes));
}

// How many rows stand on the value next to `limit`: of a coarse channel its neighbour.
std::size_t rows_at_next(std::span<const double> values, double limit) {
  double next = limit;
  for (const double value : values) {
    if (value == limit) continue;
    if (next == limit || std::abs(value - limit) < std::abs(next - limit)) next = value;
  }
  return static_cast<std::size_t>(std::ranges::count(values, next));
}

// After each row the next change of a channel in its movement; 0 where there is none.
std::vector<double> next_changes(std::span<const double> values, std::span<const int> movement) {
  std::vector<double> next(values.size(), 0.0);
  for (std::size_t i = values.size(); i-- > 1;) {
    if (movement[i] != movement[i - 1]) continue;
    next[i - 1] = values[i] != values[i - 1] ? values[i] - values[i - 1] : next[i];
  }
  return next;
}

}  // namespace

double top_speed(std::span<const double> velocity) {
  std::vector<double> speeds;
  speeds.reserve(velocity.size());
  for (const double v : velocity) speeds.push_back(std::abs(v));
  return quantile(std::move(speeds), 0.99);
}

double rest_speed(std::span<const double> velocity, double noise) {
  return std::max(kRestSpeed * top_speed(velocity), kNoises * noise);
}

double median_step(std::span<const double> time, std::span<const int> movement) {
  return quantile(steps_of(time, movement), 0.5);
}

bool is_regular(std::span<const double> time, std::span<const int> movement) {
  const std::vector<double> steps = steps_of(time, movement);
  const double middle = quantile(steps, 0.5);
  if (middle <= 0 || middle > kLongestStep * (1 + kRounding)) return false;
  const auto even =
      std::ranges::count_if(steps, [middle](double step) { return step < kUneven * middle; });
  return static_cast<double>(even) >= 0.8 * static_cast<double>(steps.size());
}

std::vector<RowRange> pieces_of(std::span<const double> time, std::span<const int> movement,
                                std::span<const char> left_out) {
  const double gap = kGap * median_step(time, movement);
  std::vector<RowRange> pieces;
  for (std::size_t begin = 0; begin < time.size();) {
    if (!left_out.empty() && left_out[begin] != 0) {
      ++begin;
      continue;
    }
    std::size_t end = begin + 1;
    while (end < time.size() && movement[end] == movement[begin] &&
           time[end] - time[end - 1] <= gap && (left_out.empty() || left_out[end] == 0)) {
      ++end;
    }
    pieces.push_back({begin, end});
    begin = end;
  }
  return pieces;
}

namespace {

// A channel that often repeats itself is coarse: its repeats say nothing.
bool is_coarse(std::span<const double> values) {
  std::size_t same = 0;
  for (std::size_t i = 1; i < values.size(); ++i) same += values[i] == values[i - 1] ? 1 : 0;
  return same * 4 > values.size();
}

}  // namespace

std::vector<char> repeated_rows(std::span<const double> position, std::span<const double> noisy,
                                std::span<const int> movement) {
  std::vector<char> repeated(position.size(), 0);
  if (is_coarse(noisy)) return repeated;
  // What comes after the repeats has gone on in the meantime; an axis at rest has not, though its
  // last count may flicker.
  const double jump = kJump * usual_change(position, movement);
  const std::vector<double> next = next_changes(position, movement);
  double before = 0;  // the movement's last change
  for (std::size_t begin = 0; begin < noisy.size();) {
    if (begin > 0 && movement[begin] != movement[begin - 1]) before = 0;
    const auto in_movement = [&](std::size_t i) {
      return i < noisy.size() && movement[i] == movement[begin];
    };
    std::size_t end = begin + 1;
    while (in_movement(end) && noisy[end] == noisy[begin] && position[end] == position[begin]) {
      ++end;
    }
    const double change = in_movement(end) ? position[end] - position[begin] : 0;
    const bool goes_on = change * before > 0 && change * next[end] > 0;
    if (end - begin >= kRepeats && (std::abs(change) > jump || goes_on)) {
      std::fill(repeated.begin() + static_cast<std::ptrdiff_t>(begin + 1),
                repeated.begin() + static_cast<std::ptrdiff_t>(end), 1);
    }
    if (change != 0) before = change;
    begin = end;
  }
  return repeated;
}

std::vector<char> stuck_rows(std::span<const double> position, std::span<const double> noisy,
                             std::span<const int> movement) {
  std::vector<char> stuck(position.size(), 0);
  if (is_coarse(noisy)) return stuck;
  const double usual = usual_change(position, movement);
  for (std::size_t begin = 0; begin < noisy.size();) {
    std::size_t end = begin + 1;
    while (end < noisy.size() && movement[end] == movement[begin] && noisy[end] == noisy[begin]) {
      ++end;
    }
    const auto [low, high] = std::ranges::minmax(position.subspan(begin, end - begin));
    const bool moves = high - low > kStuckWay * usual * static_cast<double>(end - begin);
    if (end - begin > kStuckRows && moves) {
      std::fill(stuck.begin() + static_cast<std::ptrdiff_t>(begin + 1),
                stuck.begin() + static_cast<std::ptrdiff_t>(end), 1);
    }
    begin = end;
  }
  return stuck;
}

std::vector<char> clipped_rows(std::span<const double> values) {
  std::vector<char> clipped(values.size(), 0);
  if (values.empty()) return clipped;
  const auto [low, high] = std::ranges::minmax(values);
  for (const double limit : {low, high}) {
    const auto at = static_cast<std::size_t>(std::ranges::count(values, limit));
    if (at < kFewestAtLimit || 2 * at > values.size()) continue;
    if (at <= kMoreThanNext * rows_at_next(values, limit)) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] == limit) clipped[i] = 1;
    }
  }
  return clipped;
}

Strokes strokes_of(std::span<const double> time, std::span<const double> velocity,
                   std::span<const RowRange> pieces, double noise, std::size_t fewest) {
  const double slowest = rest_speed(velocity, noise);
  const std::vector<char> rests = resting_rows(time, velocity, pieces, slowest);
  Strokes out;
  out.resting = static_cast<std::size_t>(std::ranges::count(rests, 1));
  for (const RowRange& piece : pieces) {
    std::size_t begin = piece.begin;
    double direction = 0;  // of the stroke so far; 0: none yet
    std::size_t crossing = begin;
    const auto finish = [&](std::size_t end) {
      if (end > begin && end - begin >= fewest) out.strokes.push_back({begin, end});
    };
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      if (rests[i] != 0) {
        if (i == piece.begin || rests[i - 1] == 0) {
          finish(i);
          ++out.rests;
        }
        begin = i + 1;
        direction = 0;
        continue;
      }
      const double now = velocity[i] > 0 ? 1 : velocity[i] < 0 ? -1 : 0;
      if (i > begin && velocity[i - 1] * velocity[i] <= 0) crossing = i;
      if (std::abs(velocity[i]) < slowest) continue;
      if (direction != 0 && now == -direction) {
        finish(crossing);
        begin = crossing;
        ++out.reversals;
      }
      direction = now;
    }
    finish(piece.end);
  }
  return out;
}

}  // namespace tribench
