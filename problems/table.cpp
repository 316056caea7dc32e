// SPDX-License-Identifier: MIT
#include "problems/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "foundation/error.hpp"
#include "foundation/sign.hpp"

namespace tribench {
namespace {

constexpr std::string_view kSignPrefix = "sgn_";
constexpr double kLeap = 5;  // median steps that are a break in time

std::shared_ptr<const Trail> trail_of(const Dataset& data, std::span<const Input> inputs) {
  const Channel* time = data.find(Role::time);
  if (time == nullptr) return nullptr;
  auto trail = std::make_shared<Trail>();
  trail->time = time->values;
  trail->starts = run_starts(trail->time);
  const ChannelIndex channels(data);
  for (const Input& input : inputs) trail->columns.push_back(input_values(channels, input.name));
  return trail;
}

}  // namespace

std::vector<std::size_t> run_starts(std::span<const double> time) {
  std::vector<double> steps;
  for (std::size_t r = 1; r < time.size(); ++r) {
    if (time[r] > time[r - 1]) steps.push_back(time[r] - time[r - 1]);
  }
  double longest = 0;
  if (!steps.empty()) {
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::ranges::nth_element(steps, middle);
    longest = kLeap * *middle;
  }
  std::vector<std::size_t> starts;
  for (std::size_t r = 0; r < time.size(); ++r) {
    const bool goes_on = r > 0 && time[r] > time[r - 1] && time[r] - time[r - 1] <= longest;
    if (!goes_on) starts.push_back(r);
  }
  return starts;
}

void lay_trail(const Dataset& recording, const Dataset& drawn, std::span<const Input> inputs,
               Table& table) {
  table.trail = trail_of(recording, inputs);
  if (table.trail == nullptr) return;
  const std::vector<double>& time = table.trail->time;
  const std::vector<double>& drawn_time = drawn.find(Role::time)->values;
  std::vector<std::size_t> places;
  std::size_t at = 0;
  for (std::size_t r = 0; r < drawn.rows(); ++r) {
    while (recording.movement[at] != drawn.movement[r] || time[at] != drawn_time[r]) ++at;
    places.push_back(at);
  }
  for (std::size_t& row : table.trail_row) row = places[row];
}

std::vector<double> input_values(const ChannelIndex& channels, std::string_view name) {
  if (const Channel* channel = channels.find(name)) return channel->values;
  if (name.starts_with(kSignPrefix)) {
    if (const Channel* channel = channels.find(name.substr(kSignPrefix.size()))) {
      std::vector<double> signs;
      signs.reserve(channel->values.size());
      for (const double value : channel->values) signs.push_back(sign(value));
      return signs;
    }
  }
  return channels.data().at(name).values;  // throws with the nearest name
}

void require_signs(const Dataset& data, std::span<const std::string> inputs) {
  const ChannelIndex channels(data);
  const std::unordered_set<std::string_view> named(inputs.begin(), inputs.end());
  for (const std::string& of : inputs) {
    const std::string name = std::string(kSignPrefix) + of;
    if (!named.contains(name)) continue;
    const std::vector<double> values = input_values(channels, of);
    const std::vector<double> given = input_values(channels, name);
    for (std::size_t r = 0; r < values.size(); ++r) {
      if (given[r] == sign(values[r]) || std::isnan(given[r]) || std::isnan(values[r])) continue;
      throw_bad_input(fmt::format("'{0}' is {1} where '{2}' is {3}, and the name {0} stands for "
                                  "the sign of {2}: -1, 0 or 1",
                                  name, given[r], of, values[r]),
                      data.name, "rename the column");
    }
  }
}

void link_signs(std::vector<Input>& inputs) {
  std::unordered_map<std::string_view, std::size_t> places;
  for (std::size_t j = 0; j < inputs.size(); ++j) places.emplace(inputs[j].name, j);
  for (Input& input : inputs) {
    input.sign_of.reset();
    if (!input.name.starts_with(kSignPrefix)) continue;
    const auto of = places.find(std::string_view(input.name).substr(kSignPrefix.size()));
    if (of != places.end()) input.sign_of = of->second;
  }
}

Table make_table(const KnownDataset& source, std::span<const Input> inputs, std::string_view target,
                 std::span<const char> take) {
  const Dataset& data = source.data;
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < data.rows(); ++r) {
    if (take[static_cast<std::size_t>(data.movement[r])] != 0) rows.push_back(r);
  }
  const auto gather = [&rows](const std::vector<double>& values) {
    std::vector<double> taken;
    taken.reserve(rows.size());
    for (const std::size_t r : rows) taken.push_back(values[r]);
    return taken;
  };
  Table table;
  const ChannelIndex channels(data);
  for (const Input& input : inputs) {
    table.columns.push_back(gather(input_values(channels, input.name)));
  }
  table.target = gather(data.at(target).values);
  for (const std::size_t r : rows) table.movement.push_back(data.movement[r]);
  if (!source.truth.empty()) table.truth = gather(source.truth);
  table.trail = trail_of(data, inputs);
  if (table.trail != nullptr) table.trail_row = rows;
  return table;
}

std::vector<char> draw_test_movements(const Dataset& data, double share, RandomStream random) {
  const std::size_t count = data.movement_names.size();
  // Order by mean velocity: a run of neighbours is a stratum.
  std::vector<double> mean(count, 0);
  std::vector<double> rows(count, 0);
  const Channel* velocity = data.find(Role::velocity);
  for (std::size_t r = 0; r < data.rows(); ++r) {
    const auto m = static_cast<std::size_t>(data.movement[r]);
    mean[m] += velocity == nullptr ? 0 : velocity->values[r];
    rows[m] += 1;
  }
  std::vector<std::size_t> order(count);
  for (std::size_t m = 0; m < count; ++m) {
    order[m] = m;
    if (rows[m] > 0) mean[m] /= rows[m];
  }
  std::stable_sort(order.begin(), order.end(),
                   [&mean](std::size_t a, std::size_t b) { return mean[a] < mean[b]; });
  std::vector<char> test(count, 0);
  if (count < 2) return test;
  const auto wanted = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::lround(share * static_cast<double>(count))), 1, count - 1);
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t low = count * i / wanted;
    const std::size_t high = count * (i + 1) / wanted;
    test[order[low + random.below(high - low)]] = 1;
  }
  return test;
}

KnownDataset select_rows(const KnownDataset& source, std::span<const std::size_t> rows) {
  KnownDataset selected;
  selected.data.name = source.data.name;
  selected.data.movement_names = source.data.movement_names;
  selected.data.torques_flipped = source.data.torques_flipped;
  for (const Channel& channel : source.data.channels) {
    selected.data.channels.push_back(
        {channel.name, channel.unit, channel.role, at_rows(channel.values, rows)});
  }
  selected.data.movement = at_rows(source.data.movement, rows);
  selected.truth = at_rows(source.truth, rows);
  return selected;
}

Table select_rows(const Table& table, std::span<const std::size_t> rows) {
  Table taken;
  for (const auto& column : table.columns) taken.columns.push_back(at_rows(column, rows));
  taken.target = at_rows(table.target, rows);
  taken.movement = at_rows(table.movement, rows);
  taken.truth = at_rows(table.truth, rows);
  taken.trail = table.trail;
  taken.trail_row = at_rows(table.trail_row, rows);
  return taken;
}

KnownDataset thin(const KnownDataset& source, std::size_t per_movement,
                  const RandomStream& random) {
  const std::vector<int>& movement = source.data.movement;
  std::vector<std::size_t> rows;
  for (std::size_t first = 0; first < movement.size();) {
    std::size_t end = first;
    while (end < movement.size() && movement[end] == movement[first]) ++end;
    const std::size_t count = end - first;
    RandomStream draw = random.split(static_cast<std::uint64_t>(movement[first]));
    for (std::size_t i = 0; i < std::min(per_movement, count); ++i) {
      const std::size_t runs = std::min(per_movement, count);
      const std::size_t low = count * i / runs;
      const std::size_t high = count * (i + 1) / runs;
      rows.push_back(first + low + draw.below(high - low));
    }
    first = end;
  }
  return select_rows(source, rows);
}

Dataset dataset_of_tables(const Problem& problem) {
  Dataset data;
  data.name = problem.name;
  for (const Input& input : problem.inputs) {
    data.channels.push_back({input.name, input.unit, input.role, {}});
  }
  data.channels.push_back({problem.target, problem.target_unit, Role::none, {}});
  const auto add = [&data](const Table& table, std::string_view part) {
    for (std::size_t r = 0; r < table.rows(); ++r) {
      if (r == 0 || table.movement[r] != table.movement[r - 1]) {
        data.movement_names.push_back(std::string(part) + std::to_string(table.movement[r]));
      }
      data.movement.push_back(static_cast<int>(data.movement_names.size()) - 1);
      for (std::size_t j = 0; j < table.columns.size(); ++j) {
        data.channels[j].values.push_back(table.columns[j][r]);
      }
      data.channels.back().values.push_back(table.target[r]);
    }
  };
  add(problem.stages.back().train, "train");
  add(problem.test, "test");
  return data;
}

}  // namespace tribench
