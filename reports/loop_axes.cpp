// SPDX-License-Identifier: MIT
//
// Units, axes and groups of rows in words.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reports/figures.hpp"
#include "reports/loop_words.hpp"

namespace tribench {

LoopUnit readable_unit(std::string_view unit, double size) {
  constexpr std::array<std::string_view, 7> kWithPrefix = {"N m", "N", "A", "V", "m", "s", "m/s"};
  constexpr double kMilli = 1000;
  const bool takes = std::ranges::count(kWithPrefix, unit) > 0;
  if (takes && size > 0 && size < 10 / kMilli) return {kMilli, "m" + std::string(unit)};
  return {1, std::string(unit)};
}

LoopUnit length_unit(std::string_view unit, double size) {
  constexpr double kShort = 0.1;
  if (unit == "m" && size > 0 && size < kShort) return {1000, "mm"};
  return readable_unit(unit, size);
}

std::string axis_title(const LoopAxis& axis, const LoopUnit& unit) {
  std::string words = spaced(axis.channel);
  if (axis.channel == "gravity_torque") words = "load";
  if (axis.channel == "time") words = "time";
  const bool formula = axis.channel.find_first_of("+*-/") != std::string::npos;
  if (formula) {
    words = "size of " + words;
    std::ranges::replace(words, '*', ' ');
  } else if (axis.magnitude) {
    words = axis.channel == "velocity" ? "speed" : "size of the " + words;
  }
  if (axis.period > 0) {
    words +=
        fmt::format(" within one period of {} {}", figure(unit.factor * axis.period, 3), unit.name);
    return words;
  }
  return unit.name.empty() || unit.name == "-" ? words : fmt::format("{} ({})", words, unit.name);
}

std::string split_words(const LoopSeries& series, std::string_view load_unit) {
  switch (series.split) {
    case LoopSplit::all:
      return {};
    case LoopSplit::forward:
      return "forward";
    case LoopSplit::backward:
      return "backward";
    case LoopSplit::speeding_up:
      return "speeding up";
    case LoopSplit::slowing_down:
      return "slowing down";
    case LoopSplit::driving:
      return "driving";
    case LoopSplit::back_driving:
      return "back-driving";
    case LoopSplit::load_level:
      break;
  }
  return fmt::format("load about {} {}", figure(series.level, 2), load_unit);
}

}  // namespace tribench
