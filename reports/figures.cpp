// SPDX-License-Identifier: MIT
#include "reports/figures.hpp"

#include <fmt/format.h>

#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench {

std::string figure(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (value == 0) return "0";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  // Rounded first, so that 9.996 counts as 10.0 and not as 10.00.
  const int exponent = static_cast<int>(std::floor(
      elementary::log10(std::stod(fmt::format("{:.{}e}", std::abs(value), digits - 1)))));
  if (exponent < -4 || exponent > 6) return fmt::format("{:.{}e}", value, digits - 1);
  const int decimals = digits - 1 - exponent;
  return fmt::format("{:.{}f}", value, decimals > 0 ? decimals : 0);
}

std::string count_figure(double count) {
  return std::isnan(count) ? std::string("-") : fmt::format("{}", count);
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string ratio_figure(double ratio) {
  if (!(ratio < 100)) return figure(ratio, 2);
  return figure(ratio, ratio < 10 ? 3 : 2);
}

std::string duration_figure(double seconds) {
  if (std::isnan(seconds)) return "-";
  if (seconds < 120) return figure(seconds) + " s";
  if (seconds < 7200) return figure(seconds / 60) + " min";
  return figure(seconds / 3600) + " h";
}

}  // namespace tribench
