// SPDX-License-Identifier: MIT
#include "problems/reading/recording_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "problems/reading/channel_names.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewestRowsOfScale = 100;
constexpr double kThousand = 1000;
constexpr double kNearThousand = 4;  // times: torques of two motions differ by that
constexpr double kAlikeEfforts = 4;  // times, of all the others
constexpr double kAlikeMotion = 30;  // times: more is a joint that rests in one of them
constexpr double kSamePace = 0.1;

double ninth_tenth(const std::vector<double>& values) {
  std::vector<double> sizes;
  sizes.reserve(values.size());
  for (const double value : values) sizes.push_back(std::abs(value));
  return quantile(sizes, 0.9);
}

std::optional<double> pace_of(const Dataset& data) {
  const Channel* t = data.find(Role::time);
  const Channel* q = data.find(Role::position);
  const Channel* v = data.find(Role::velocity);
  if (t == nullptr || q == nullptr || v == nullptr) return {};
  double with = 0;
  double squares = 0;
  double all = 0;
  for (std::size_t r = 1; r < data.rows(); ++r) {
    if (data.movement[r] != data.movement[r - 1]) continue;
    const double way = 0.5 * (v->values[r] + v->values[r - 1]) * (t->values[r] - t->values[r - 1]);
    const double step = q->values[r] - q->values[r - 1];
    with += step * way;
    squares += way * way;
    all += step * step;
  }
  // Steps that do not go with the velocity (a counter that is full, stamps that jitter) tell none.
  constexpr double kGoesWith = 0.8;  // correlation
  if (!(with > kGoesWith * std::sqrt(squares * all))) return {};
  return with / squares;
}

bool is_near(double ratio, double factor, double times) {
  return ratio > factor / times && ratio < factor * times;
}

// The sizes of a column in the other recordings.
template <typename SizeOf>
std::vector<double> sizes_of_others(std::span<const RecordingScale> recordings, std::size_t odd,
                                    SizeOf size_of) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    if (k != odd) sizes.push_back(size_of(recordings[k]));
  }
  return sizes;
}

void check_efforts(std::span<const RecordingScale> recordings, std::size_t odd,
                   std::vector<std::string>& warnings) {
  const RecordingScale& one = recordings[odd];
  const std::vector<double> motions =
      sizes_of_others(recordings, odd, [](const RecordingScale& other) { return other.motion; });
  const auto moves_alike = [&](double motion) {
    return motion > 0 && one.motion > 0 && is_near(one.motion / motion, 1, kAlikeMotion);
  };
  if (!std::ranges::all_of(motions, moves_alike)) return;
  for (const auto& [column, size] : one.efforts) {
    const auto in_others =
        sizes_of_others(recordings, odd, [&column = column](const RecordingScale& other) {
          const auto found = other.efforts.find(column);
          return found != other.efforts.end() ? found->second : 0;
        });
    const auto [least, most] = std::ranges::minmax(in_others);
    if (!(least > 0) || most > kAlikeEfforts * least || !(size > 0)) continue;
    const auto is_thousand_of = [&, size = size](double factor) {
      return std::ranges::all_of(
          in_others, [&](double other) { return is_near(size / other, factor, kNearThousand); });
    };
    const bool is_larger = is_thousand_of(kThousand);
    if (!is_larger && !is_thousand_of(1 / kThousand)) continue;
    const std::string what = fmt::format(
        "'{}' is about 1000 times as {} here ({:.3g}, which nine rows of ten stay "
        "below) as in every other file ({:.3g} to {:.3g}), as mA beside A and N mm beside N m are",
        column, is_larger ? "large" : "small", size, least, most);
    const std::string mend = fmt::format(
        "write each file's unit into its header ('{} [UNIT]'), or bring this one's numbers to the "
        "unit of the others",
        without_unit(column));
    if (is_larger && in_others.size() > 1) throw_bad_input(what, one.file, mend);
    // Of two the larger one tells it.
    if (is_larger || in_others.size() > 1) {
      warnings.push_back(fmt::format("{}: {}; {}", one.file, what, mend));
    }
  }
}

void check_pace(std::span<const RecordingScale> recordings, std::size_t odd) {
  const RecordingScale& one = recordings[odd];
  if (!one.pace) return;
  const auto paces = sizes_of_others(
      recordings, odd, [](const RecordingScale& other) { return other.pace.value_or(0); });
  const auto [least, most] = std::ranges::minmax(paces);
  if (!(least > 0) || most > (1 + kSamePace) * least) return;
  constexpr double kDegrees = 180 / std::numbers::pi;
  for (const double factor : {kDegrees, 1 / kDegrees, kThousand, 1 / kThousand}) {
    if (!is_near(*one.pace / least, factor, 1 + kSamePace)) continue;
    throw_bad_input(
        fmt::format("'{}' changes {:.4g} times as much with '{}' here as in every other file",
                    one.position, *one.pace / least, one.velocity),
        one.file,
        "one of the two has another unit in this file: write it into the header, or bring its "
        "numbers to the unit of the others");
  }
}

}  // namespace

RecordingScale scale_of(const Dataset& data, std::string_view file) {
  RecordingScale scale;
  scale.file = file;
  if (data.rows() < kFewestRowsOfScale) return scale;
  for (const Channel& channel : data.channels) {
    const bool is_effort = channel.role == Role::motor_torque ||
                           channel.role == Role::motor_current ||
                           channel.role == Role::friction_torque;
    if (is_effort) scale.efforts[channel.name] = ninth_tenth(channel.values);
  }
  const Channel* q = data.find(Role::position);
  const Channel* v = data.find(Role::velocity);
  if (q != nullptr) {
    const auto [low, high] = std::ranges::minmax(q->values);
    scale.motion = high - low;
    scale.position = q->name;
  }
  if (v != nullptr) {
    scale.motion = ninth_tenth(v->values);
    scale.velocity = v->name;
  }
  scale.pace = pace_of(data);
  return scale;
}

std::vector<std::string> check_scales(std::span<const RecordingScale> recordings) {
  std::vector<std::string> warnings;
  for (std::size_t odd = 0; odd < recordings.size() && recordings.size() > 1; ++odd) {
    check_efforts(recordings, odd, warnings);
    check_pace(recordings, odd);
  }
  return warnings;
}

}  // namespace tribench
