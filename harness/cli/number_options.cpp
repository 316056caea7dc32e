// SPDX-License-Identifier: MIT
#include "harness/cli/number_options.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "foundation/number_text.hpp"

namespace tribench {
namespace {

// CLI11 takes what a validator returns for its complaint.
std::string refusal(const std::string& text, const std::string& wanted) {
  return fmt::format("'{}' cannot be used; use {}", text, wanted);
}

}  // namespace

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  const std::string wanted = fmt::format("a whole number from {} to {}", low, high);
  return {[=](std::string& text) -> std::string {
            const std::optional<std::uint64_t> number = read_number<std::uint64_t>(text);
            if (!number || *number < low || *number > high) return refusal(text, wanted);
            text = std::to_string(*number);
            return {};
          },
          high == kAnyWhole ? std::string() : fmt::format("{} to {}", low, high)};
}

CLI::Validator real_number(double low, double high, LowEnd low_end) {
  const std::string wanted = low_end == LowEnd::above
                                 ? fmt::format("a number above {}, up to {}", low, high)
                                 : fmt::format("a number from {} to {}", low, high);
  return {[=](std::string& text) -> std::string {
            const std::optional<double> number = read_number<double>(text);
            const bool fits = number && *number <= high &&
                              (low_end == LowEnd::above ? *number > low : *number >= low);
            if (!fits) return refusal(text, wanted);
            text = fmt::format("{}", *number);
            return {};
          },
          fmt::format("{} to {}", low, high)};
}

}  // namespace tribench
