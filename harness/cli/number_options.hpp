// SPDX-License-Identifier: MIT
//
// Numbers on the command line, read strictly and held to a range. Every option that takes a number
// has one of these as its transform; a test asks each of them for text that is no such number.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>

namespace tribench {

inline constexpr std::uint64_t kAnyWhole = std::numeric_limits<std::uint64_t>::max();

// command->add_option("--jobs", jobs, "...")->transform(whole_number(1, 4096)); 1e3 is one too.
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high = kAnyWhole);
// Finite, from low to high; `low` itself is left out where it is `above`.
enum class LowEnd { included, above };
CLI::Validator real_number(double low, double high, LowEnd low_end = LowEnd::included);

}  // namespace tribench
