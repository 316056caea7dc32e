// SPDX-License-Identifier: MIT
#include "problems/reading/time_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "problems/reading/csv_scanner.hpp"

namespace tribench {
namespace {

constexpr std::size_t kOvertaken = 16;           // rows: more that are late are another recording
constexpr double kFewOvertaken = 0.05;           // of the rows
constexpr std::size_t kFewestOfRecording = 100;  // rows

// Whether the values change in every row of `restarts` and in no other (restarts[0] is not asked).
template <typename Value>
bool changes_with(const std::vector<Value>& values, const std::vector<char>& restarts) {
  for (std::size_t r = 1; r < values.size(); ++r) {
    if ((values[r] != values[r - 1]) != (restarts[r] != 0)) return false;
  }
  return true;
}

// The column that names the recordings; empty: none does.
std::string column_of_recordings(const DataFile& reading, const Channel& time) {
  std::vector<char> restarts(time.values.size(), 0);
  for (std::size_t r = 1; r < restarts.size(); ++r) {
    restarts[r] = time.values[r] < time.values[r - 1] ? 1 : 0;
  }
  for (const TextColumn& column : reading.texts) {
    if (changes_with(column.values, restarts)) return column.name;
  }
  for (const Channel& channel : reading.data.channels) {
    const bool asked_for = std::ranges::count(reading.spare, channel.name) == 0;
    if (&channel != &time && asked_for && changes_with(channel.values, restarts)) {
      return channel.name;
    }
  }
  return {};
}

std::string mend_of_time(const DataFile& reading, const Channel& time) {
  if (reading.data.movement_names.size() > 1) return "sort the rows of a movement by time";
  const std::string recordings = column_of_recordings(reading, time);
  if (recordings.empty()) {
    return "sort the rows by time, or name the recordings in a column 'movement'";
  }
  return fmt::format(
      "'{}' changes wherever time begins anew: if it names the recordings, say --roles {}=movement",
      recordings, recordings);
}

struct TimeBreaks {
  std::size_t overtaken = 0;  // rows
  std::size_t first_overtaken = 0;
  std::vector<std::size_t> restarts;  // rows from which time runs anew
  std::size_t first_back = 0;         // row; 0: time runs forward throughout
};

TimeBreaks find_breaks(const std::vector<double>& time, const std::vector<int>& movement) {
  TimeBreaks breaks;
  double latest = time.empty() ? 0 : time.front();
  for (std::size_t r = 1; r < time.size(); ++r) {
    if (movement[r] != movement[r - 1] || time[r] >= latest) {
      latest = time[r];
      continue;
    }
    std::size_t end = r + 1;
    while (end < time.size() && movement[end] == movement[r] && time[end] < latest &&
           end - r <= kOvertaken) {
      ++end;
    }
    if (breaks.first_back == 0) breaks.first_back = r;
    if (end - r > kOvertaken) {
      breaks.restarts.push_back(r);
      latest = time[r];
      continue;
    }
    if (breaks.overtaken == 0) breaks.first_overtaken = r;
    breaks.overtaken += end - r;
    r = end - 1;
  }
  return breaks;
}

// What a counter of milli-, micro- or nanoseconds holds that was full between two rows: the first
// has one of its last counts and the second one of its first. 0: there is none.
double full_counter(double before, double now, double usual_step) {
  constexpr double kNear = 2.5;        // usual steps
  constexpr double kFewestRows = 100;  // of a counter: a shorter one would be full all the time
  for (const int bits : {16, 31, 32}) {
    for (const double count : {1e-3, 1e-6, 1e-9}) {
      const double span = std::ldexp(count, bits);
      if (span < kFewestRows * usual_step) continue;
      const double step = now - before + span;
      if (now >= 0 && before < span && step < kNear * usual_step) return span;
    }
  }
  return 0;
}

// A clock that starts again where its counter is full goes on.
void unwrap_clock(DataFile& reading) {
  const auto clock = std::ranges::find(reading.data.channels, Role::time, &Channel::role);
  std::vector<double>& time = clock->values;
  const std::vector<int>& movement = reading.data.movement;
  std::vector<double> steps;
  for (std::size_t r = 1; r < time.size(); ++r) {
    if (movement[r] == movement[r - 1]) steps.push_back(std::abs(time[r] - time[r - 1]));
  }
  if (steps.empty()) return;
  const double usual = upper_median(std::move(steps));
  std::size_t times = 0;
  double span = 0;
  double offset = 0;
  double before = time.front();  // as it was told
  for (std::size_t r = 1; r < time.size(); ++r) {
    if (movement[r] != movement[r - 1]) offset = 0;
    const double told = time[r];
    if (told < before && movement[r] == movement[r - 1]) {
      const double full = full_counter(before, told, usual);
      times += full > 0 ? 1 : 0;
      if (full > 0) span = full;
      offset += full;
    }
    before = told;
    time[r] += offset;
  }
  if (times == 0) return;
  reading.warnings.push_back(fmt::format(
      "'{}' starts again {} times after {:.4f} s, as a full counter does: the clock goes on",
      clock->name, times, span));
}

bool are_long_enough(const std::vector<std::size_t>& restarts, std::size_t rows) {
  std::size_t begin = 0;
  for (const std::size_t r : restarts) {
    if (r - begin < kFewestOfRecording) return false;
    begin = r;
  }
  return rows - begin >= kFewestOfRecording;
}

template <typename Value>
void put_in_order(std::vector<Value>& values, const std::vector<std::size_t>& order) {
  std::vector<Value> sorted;
  sorted.reserve(order.size());
  for (const std::size_t r : order) sorted.push_back(std::move(values[r]));
  values = std::move(sorted);
}

void put_in_order(DataFile& reading, const std::vector<std::size_t>& order) {
  for (Channel& channel : reading.data.channels) put_in_order(channel.values, order);
  for (TextColumn& text : reading.texts) put_in_order(text.values, order);
}

void sort_by_time(DataFile& reading) {
  const std::vector<double>& time = reading.data.find(Role::time)->values;
  const std::vector<int>& movement = reading.data.movement;
  std::vector<std::size_t> order(time.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(movement[a], time[a]) < std::pair(movement[b], time[b]);
  });
  put_in_order(reading, order);
}

// The newest row stands first, throughout.
bool is_newest_first(const Dataset& data, const std::vector<double>& time) {
  return data.movement_names.size() == 1 && data.rows() > 2 * kFewestOfRecording &&
         std::ranges::is_sorted(time, std::greater<>()) && time.front() > time.back();
}

}  // namespace

void order_by_time(DataFile& reading, const std::function<std::size_t(std::size_t)>& line_of,
                   std::string_view file) {
  Dataset& data = reading.data;
  const Channel* channel = data.find(Role::time);
  if (channel == nullptr) return;
  const std::vector<double>& time = channel->values;
  if (is_newest_first(data, time)) {
    std::vector<std::size_t> order(time.size());
    std::iota(order.rbegin(), order.rend(), std::size_t{0});
    put_in_order(reading, order);
    reading.warnings.emplace_back("the newest row stands first: the rows are turned round");
    return;
  }
  unwrap_clock(reading);
  const TimeBreaks breaks = find_breaks(time, data.movement);
  if (breaks.first_back == 0) return;
  const bool few =
      static_cast<double>(breaks.overtaken) <= kFewOvertaken * static_cast<double>(data.rows());
  const bool anew = breaks.restarts.empty() ||
                    (!reading.has_movements && are_long_enough(breaks.restarts, data.rows()) &&
                     column_of_recordings(reading, *channel).empty());
  if (!few || !anew) {
    const std::size_t r = breaks.first_back;
    throw_bad_input(fmt::format("time runs back from {} to {}", time[r - 1], time[r]),
                    csv_place(file, line_of(r), channel->name), mend_of_time(reading, *channel));
  }
  for (const std::size_t r : breaks.restarts) {
    reading.warnings.push_back(
        fmt::format("time runs back from {} to {} s in line {}: another recording begins there",
                    time[r - 1], time[r], line_of(r)));
  }
  if (!breaks.restarts.empty()) cut_movements(data, breaks.restarts);
  if (breaks.overtaken == 0) return;
  reading.warnings.push_back(
      fmt::format("{} rows stand out of the order of time, the first in line {}: sorted",
                  breaks.overtaken, line_of(breaks.first_overtaken)));
  sort_by_time(reading);
}

}  // namespace tribench
