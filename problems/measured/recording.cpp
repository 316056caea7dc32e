// SPDX-License-Identifier: MIT
#include "problems/measured/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/sign.hpp"
#include "problems/measured/decimate.hpp"
#include "problems/reading/csv.hpp"
#include "problems/table.hpp"

namespace tribench::measured {
namespace {

// Slower than this part of the top speed, a velocity has no sign: noise at standstill is no
// reversal.
constexpr double kStandstill = 0.01;

CsvOptions options_of(const ProblemPlan& plan) {
  CsvOptions options;
  for (const auto& [column, meaning] : plan.columns) options.roles[column] = meaning.role;
  if (plan.movements.kind == MovementRule::Kind::column) {
    options.roles[plan.movements.column] = Role::movement;
  }
  return options;
}

Dataset keep_rows(const Dataset& data, const ProblemPlan& plan) {
  const std::vector<double>& values = data.at(plan.keep_column).values;
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < values.size(); ++r) {
    if (values[r] == plan.keep_value) rows.push_back(r);
  }
  return select_rows({data, {}}, rows).data;
}

void add_derived(Dataset& data, const DerivedChannel& derived) {
  Channel channel{derived.name, derived.unit, derived.role, data.at(derived.of[0]).values};
  for (std::size_t r = 0; r < channel.values.size(); ++r) {
    double& value = channel.values[r];
    switch (derived.kind) {
      case DerivedChannel::Kind::sign:
        value = sign(value);
        break;
      case DerivedChannel::Kind::difference:
        value -= data.at(derived.of[1]).values[r];
        break;
      case DerivedChannel::Kind::scaled:
        value *= derived.factor;
        break;
    }
  }
  data.channels.push_back(std::move(channel));
}

void cut_at_reversals(Dataset& data) {
  const Channel* velocity = data.find(Role::velocity);
  if (velocity == nullptr) throw_bad_input("no velocity to cut movements by", data.name);
  double top = 0;
  for (const double v : velocity->values) top = std::max(top, std::abs(v));
  double direction = 0;
  int movement = -1;
  int before = -1;
  std::vector<int> cut;
  std::vector<std::string> names;
  for (std::size_t r = 0; r < data.rows(); ++r) {
    const double v = velocity->values[r];
    const double now = std::abs(v) > kStandstill * top ? sign(v) : 0;
    if (data.movement[r] != before || (now != 0 && direction != 0 && now != direction)) {
      ++movement;
      before = data.movement[r];
      names.push_back(fmt::format("stroke {}", movement + 1));
      direction = now;
    }
    if (now != 0) direction = now;
    cut.push_back(movement);
  }
  data.movement = std::move(cut);
  data.movement_names = std::move(names);
}

void cut_into_pieces(Dataset& data, std::size_t pieces) {
  std::vector<int> cut;
  std::vector<std::string> names;
  for (std::size_t first = 0; first < data.rows();) {
    std::size_t end = first;
    while (end < data.rows() && data.movement[end] == data.movement[first]) ++end;
    const std::string& name = data.movement_names[static_cast<std::size_t>(data.movement[first])];
    std::size_t last = pieces;  // none yet
    for (std::size_t r = first; r < end; ++r) {
      const std::size_t piece = (r - first) * pieces / (end - first);
      if (piece != last) names.push_back(fmt::format("{} {}/{}", name, piece + 1, pieces));
      last = piece;
      cut.push_back(static_cast<int>(names.size()) - 1);
    }
    first = end;
  }
  data.movement = std::move(cut);
  data.movement_names = std::move(names);
}

void decimate_channels(Dataset& data, int factor) {
  for (Channel& channel : data.channels) {
    if (channel.role == Role::time) {
      std::vector<double> kept;
      for (std::size_t r = 0; r < channel.values.size(); r += static_cast<std::size_t>(factor)) {
        kept.push_back(channel.values[r]);
      }
      channel.values = std::move(kept);
    } else {
      channel.values = decimate(channel.values, factor);
    }
  }
  std::vector<int> movement;
  for (std::size_t r = 0; r < data.rows(); r += static_cast<std::size_t>(factor)) {
    movement.push_back(data.movement[r]);
  }
  data.movement = std::move(movement);
}

Dataset averaged(const Dataset& data) {
  Dataset means;
  means.name = data.name;
  means.movement_names = data.movement_names;
  std::vector<double> rows(data.movement_names.size(), 0);
  for (const int movement : data.movement) rows[static_cast<std::size_t>(movement)] += 1;
  for (std::size_t m = 0; m < rows.size(); ++m) means.movement.push_back(static_cast<int>(m));
  for (const Channel& channel : data.channels) {
    Channel mean{channel.name, channel.unit, channel.role, std::vector<double>(rows.size(), 0)};
    for (std::size_t r = 0; r < data.rows(); ++r) {
      const auto m = static_cast<std::size_t>(data.movement[r]);
      mean.values[m] += channel.values[r];
    }
    for (std::size_t m = 0; m < rows.size(); ++m) mean.values[m] /= rows[m];
    means.channels.push_back(std::move(mean));
  }
  return means;
}

}  // namespace

Dataset read_recording(const ProblemPlan& plan, const std::filesystem::path& file) {
  Dataset data = read_csv(file, options_of(plan)).data;
  for (Channel& channel : data.channels) {
    const auto meaning = plan.columns.find(channel.name);
    if (meaning != plan.columns.end() && meaning->second.unit) {
      channel.unit = *meaning->second.unit;
    }
  }
  if (!plan.keep_column.empty()) data = keep_rows(data, plan);
  for (const DerivedChannel& derived : plan.derived) add_derived(data, derived);
  if (plan.movements.kind == MovementRule::Kind::reversals) cut_at_reversals(data);
  if (plan.movements.pieces > 1) {
    cut_into_pieces(data, static_cast<std::size_t>(plan.movements.pieces));
  }
  if (plan.decimate > 1) decimate_channels(data, plan.decimate);
  return plan.average ? averaged(data) : data;
}

}  // namespace tribench::measured
