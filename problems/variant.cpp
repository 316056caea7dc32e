// SPDX-License-Identifier: MIT
#include "problems/variant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/random.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

constexpr double kMostNoise = 1000;
constexpr double kMostRows = 1e9;

struct Changes {
  double noise = 0;
  std::size_t rows = 0;  // 0: all
};

Changes parse_changes(const std::string& suffix, const std::string& name) {
  Changes changes;
  std::vector<std::string> parts = split(suffix.substr(1), '~');
  if (parts.empty()) parts.emplace_back();  // "NAME~", to be refused
  for (const std::string& part : parts) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string key = part.substr(0, equals);
    const auto value = equals < part.size() ? read_number<double>(part.substr(equals + 1))
                                            : std::optional<double>();
    const auto refuse = [&](std::string_view wanted) {
      throw_bad_input(fmt::format("'~{}' changes nothing in a problem", part), name, wanted);
    };
    if (key == kNoiseKey && value && *value >= 0 && *value <= kMostNoise) {
      changes.noise = *value;
    } else if (key == kRowsKey && value && *value >= 1 && *value <= kMostRows &&
               *value == std::floor(*value)) {
      changes.rows = static_cast<std::size_t>(*value);
    } else if (key == kNoiseKey) {
      refuse(fmt::format("noise is a share of the target's deviation, a number from 0 to {}",
                         kMostNoise));
    } else if (key == kRowsKey) {
      refuse(fmt::format("rows is a whole number from 1 to {}", kMostRows));
    } else {
      refuse("write ~noise=0.1 (a share of the target's deviation) or ~rows=50");
    }
  }
  return changes;
}

void keep_rows(Table& table, std::size_t count, RandomStream random, const std::string& name) {
  if (table.rows() < count) {
    throw_bad_input(fmt::format("it has {} training rows, not {}", table.rows(), count), name,
                    "sweep fewer rows");
  }
  std::vector<std::size_t> places(table.rows());
  std::iota(places.begin(), places.end(), std::size_t{0});
  random.shuffle(std::span(places));
  places.resize(count);
  std::ranges::sort(places);
  const auto keep = [&places](auto& values) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < places.size(); ++i) values[i] = values[places[i]];
    values.resize(places.size());
  };
  for (std::vector<double>& column : table.columns) keep(column);
  keep(table.target);
  keep(table.movement);
  keep(table.truth);
  keep(table.trail_row);
}

void add_noise(Table& table, double share, RandomStream random) {
  const auto n = static_cast<double>(table.rows());
  double mean = 0;
  double variance = 0;
  for (const double value : table.target) mean += value / n;
  for (const double value : table.target) variance += (value - mean) * (value - mean) / n;
  // What the noise hides is the truth from here on.
  if (table.truth.empty()) table.truth = table.target;
  const double deviation = share * std::sqrt(variance);
  for (double& value : table.target) value += deviation * random.normal();
}

}  // namespace

std::pair<std::string, std::string> split_variant(std::string_view name) {
  const std::size_t at = std::min(name.find('~'), name.size());
  return {std::string(name.substr(0, at)), std::string(name.substr(at))};
}

std::string variant_suffix(std::string_view key, double value) {
  return fmt::format("~{}={}", key, value);
}

void check_variant(const std::string& suffix) {
  if (!suffix.empty()) parse_changes(suffix, {});
}

ProblemEntry varied(const ProblemEntry& base, const std::string& suffix) {
  const std::string name = base.name + suffix;
  const Changes changes = parse_changes(suffix, name);
  ProblemEntry entry = base;
  entry.name = name;
  entry.summary = fmt::format("{}; {}", base.summary, suffix.substr(1));
  entry.data = {};
  entry.make = [make = base.make, base_name = base.name, name, changes](std::uint64_t seed) {
    Problem problem = make(seed);
    problem.name = name;
    // Keyed by the problem alone: more noise is the same noise, larger.
    const RandomStream random = RandomStream(key_of(base_name)).split(seed).split("variant");
    for (std::size_t s = 0; s < problem.stages.size(); ++s) {
      Table& train = problem.stages[s].train;
      if (changes.rows > 0) keep_rows(train, changes.rows, random.split("rows").split(s), name);
      if (changes.noise > 0) add_noise(train, changes.noise, random.split("noise").split(s));
    }
    return problem;
  };
  return entry;
}

}  // namespace tribench
