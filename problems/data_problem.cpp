// SPDX-License-Identifier: MIT
#include "problems/data_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_set>

#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "problems/friction_sign.hpp"
#include "problems/reading/channel_names.hpp"
#include "problems/reading/csv_cells.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

// Fits square what they are given: numbers that are all as small vanish then.
void require_squares(const Channel& target, const std::string& place) {
  constexpr double kSmallest = 1 / kLargestNumber;
  double largest = 0;
  for (const double value : target.values) largest = std::max(largest, std::abs(value));
  if (largest == 0 || largest >= kSmallest) return;
  throw_bad_input(
      fmt::format("no value of the target '{}' is larger than {}", target.name, largest), place,
      "give it in a smaller unit: squares of such numbers are no doubles");
}

// Of an input sgn_X that is derived from X.
Role role_of_sign(const ChannelIndex& channels, std::string_view name) {
  const Channel* of = channels.find(name.substr(std::string_view("sgn_").size()));
  if (of != nullptr && of->role == Role::velocity) return Role::velocity_sign;
  if (of != nullptr && of->role == Role::gravity_torque) return Role::gravity_sign;
  return Role::none;
}

std::vector<Input> make_inputs(const Dataset& data, const std::string& target,
                               std::span<const std::string> names) {
  if (names.empty()) throw_bad_input("no input is given", data.name, "name at least one column");
  if (names.size() > kMostInputs) {
    throw_bad_input(fmt::format("{} inputs are given", names.size()), data.name,
                    fmt::format("a formula can name {}: name those that matter", kMostInputs));
  }
  const ChannelIndex channels(data);
  std::unordered_set<std::string_view> seen;
  std::vector<Input> inputs;
  inputs.reserve(names.size());
  for (const std::string& name : names) {
    require_formula_name(name, data.name);
    if (name == target) {
      throw_bad_input(fmt::format("'{}' is the target and an input", name), data.name,
                      "remove it from the inputs");
    }
    if (name == "sgn_" + target && channels.find(name) == nullptr) {
      throw_bad_input(fmt::format("'{}' is the sign of the target and an input", name), data.name,
                      "remove it from the inputs");
    }
    if (!seen.insert(name).second) {
      throw_bad_input(fmt::format("input '{}' is named twice", name), data.name, "name it once");
    }
    const std::vector<double> values = input_values(channels, name);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const Channel* channel = channels.find(name);
    inputs.push_back({name,
                      channel != nullptr ? channel->unit : "-",
                      channel != nullptr ? channel->role : role_of_sign(channels, name),
                      *low,
                      *high,
                      {}});
  }
  link_signs(inputs);
  require_signs(data, names);
  return inputs;
}

void widen_box(std::vector<Input>& inputs, const std::vector<Input>& others) {
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    inputs[j].low = std::min(inputs[j].low, others[j].low);
    inputs[j].high = std::max(inputs[j].high, others[j].high);
  }
}

void check_target(const Dataset& data, const std::string& target) {
  require_squares(data.at(target), data.name);
  refuse_opposing_friction(data, target);
}

Table whole_table(const Dataset& data, std::span<const Input> inputs, const std::string& target) {
  const std::vector<char> all(data.movement_names.size(), 1);
  return make_table({data, {}}, inputs, target, all);
}

}  // namespace

void refuse_opposing_friction(const Dataset& data, std::string_view target) {
  const Channel& friction = data.at(target);
  const Channel* velocity = data.find(Role::velocity);
  if (friction.role != Role::friction_torque || velocity == nullptr) return;
  refuse_opposing_friction(friction.values, friction.name, velocity->values, velocity->name,
                           data.name, mend_of_sign(data.torques_flipped));
}

void flip_torques(Dataset& data) {
  data.torques_flipped = !data.torques_flipped;
  for (Channel& channel : data.channels) {
    if (channel.role == Role::gravity_sign || is_torque_like(channel.role)) {
      for (double& value : channel.values) value = value == 0 ? value : -value;
    }
  }
}

Problem make_data_problem(const Dataset& train, const Dataset* test, const std::string& target,
                          std::span<const std::string> inputs) {
  check_target(train, target);
  Problem problem;
  problem.name = train.name;
  problem.summary = fmt::format("{} from {}", target, fmt::join(inputs, ", "));
  problem.dataset = train.name;
  problem.target = target;
  problem.target_unit = train.at(target).unit;
  problem.inputs = make_inputs(train, target, inputs);
  std::vector<std::size_t> places(problem.inputs.size());
  for (std::size_t j = 0; j < places.size(); ++j) places[j] = j;
  problem.stages.push_back({"fit", std::move(places), whole_table(train, problem.inputs, target)});
  if (test != nullptr) {
    check_target(*test, target);
    widen_box(problem.inputs, make_inputs(*test, target, inputs));
    problem.test = whole_table(*test, problem.inputs, target);
  }
  problem.test.columns.resize(problem.inputs.size());
  return problem;
}

}  // namespace tribench
