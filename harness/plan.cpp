// SPDX-License-Identifier: MIT
#include "harness/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench {
namespace {

// Node-rows a second of a whole fit, cautiously: the evaluator alone is several times faster.
constexpr double kNodeRowsPerSecond = 3e8;
// Starting values, fixed forms and judging: what a cell costs before its budget counts.
constexpr double kBaseSeconds = 0.05;

}  // namespace

Shard parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto index = read_number<std::size_t>(text.substr(0, slash));
  const auto count = slash == std::string_view::npos
                         ? std::nullopt
                         : read_number<std::size_t>(text.substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count) {
    throw_bad_input(fmt::format("'{}' is no shard", text), "--shard",
                    "use K/N with K from 1 to N, as in 3/8");
  }
  return {*index, *count};
}

MeasuredCosts measured_costs(const RunFolder& run) {
  std::map<std::string, std::vector<double>, std::less<>> seconds;
  for (const Record& record : run.records) {
    if (is_ok(record)) seconds[record.method].push_back(record.fit_cpu_s);
  }
  MeasuredCosts costs;
  for (const auto& [method, values] : seconds) costs[method] = kBaseSeconds + median(values);
  return costs;
}

double predict_seconds(const Grid& grid, const Cell& cell, const MeasuredCosts& costs) {
  const auto measured = costs.find(cell.method);
  if (measured != costs.end()) return measured->second;
  const Method& method = grid.method(cell.method);
  const CellLimits limits = grid.limits_of(method);
  if (method.is_external()) return limits.seconds;
  if (method.fixed_form) return kBaseSeconds;
  return kBaseSeconds +
         std::min(limits.seconds, static_cast<double>(limits.evaluations) / kNodeRowsPerSecond);
}

void for_each_planned(const Grid& grid, const Shard& shard, const MeasuredCosts& costs,
                      const std::function<void(const PlannedWork&)>& take) {
  // Among cells of equal cost those that share their data stand together: making data costs time.
  std::map<std::string, std::uint32_t> place_of_problem;
  for (const std::string& name : grid.problems) {
    place_of_problem.emplace(name, place_of_problem.size());
  }
  struct Place {
    double predicted_s;
    std::uint32_t problem;
    std::uint32_t series;
    std::uint64_t seed;
  };
  const std::vector<Cell> series = grid.series();
  std::vector<Place> places;
  places.reserve(series.size() * grid.seed_count);
  for (std::uint32_t s = 0; s < series.size(); ++s) {
    const double predicted_s = predict_seconds(grid, series[s], costs);
    const std::uint32_t problem = place_of_problem.at(series[s].problem);
    for (std::uint64_t i = 0; i < grid.seed_count; ++i) {
      places.push_back({predicted_s, problem, s, series[s].seed + i});
    }
  }
  std::ranges::sort(places, {}, [](const Place& place) {
    return std::make_tuple(-place.predicted_s, place.problem, place.seed, place.series);
  });
  for (std::size_t i = shard.index - 1; i < places.size(); i += shard.count) {
    PlannedWork item{series[places[i].series], places[i].predicted_s};
    item.cell.seed = places[i].seed;
    take(item);
  }
}

std::vector<PlannedWork> plan_work(const Grid& grid, const Shard& shard,
                                   const MeasuredCosts& costs) {
  std::vector<PlannedWork> part;
  part.reserve(grid.cell_count() / shard.count + 1);
  for_each_planned(grid, shard, costs, [&](const PlannedWork& item) { part.push_back(item); });
  return part;
}

}  // namespace tribench
