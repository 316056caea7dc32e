// SPDX-License-Identifier: MIT
#include "problems/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace {

constexpr std::array<std::pair<Role, std::string_view>, 16> kRoleNames = {{
    {Role::none, "none"},
    {Role::time, "time"},
    {Role::movement, "movement"},
    {Role::position, "position"},
    {Role::velocity, "velocity"},
    {Role::velocity_sign, "velocity_sign"},
    {Role::acceleration, "acceleration"},
    {Role::gravity_torque, "gravity_torque"},
    {Role::gravity_sign, "gravity_sign"},
    {Role::motor_torque, "motor_torque"},
    {Role::friction_torque, "friction_torque"},
    {Role::external_torque, "external_torque"},
    {Role::temperature, "temperature"},
    {Role::motor_current, "motor_current"},
    {Role::other_velocity, "other_velocity"},
    {Role::other_acceleration, "other_acceleration"},
}};

}  // namespace

std::string_view role_name(Role role) {
  for (const auto& [known, name] : kRoleNames) {
    if (known == role) return name;
  }
  return "none";
}

Role find_role(std::string_view name, std::string_view place) {
  std::vector<std::string> names;
  for (const auto& [role, known] : kRoleNames) {
    if (known == name) return role;
    names.emplace_back(known);
  }
  throw_bad_input(fmt::format("there is no role '{}'", name), place, did_you_mean(name, names));
}

const Channel* Dataset::find(std::string_view channel_name) const {
  for (const Channel& channel : channels) {
    if (channel.name == channel_name) return &channel;
  }
  return nullptr;
}

const Channel* Dataset::find(Role role) const {
  for (const Channel& channel : channels) {
    if (channel.role == role) return &channel;
  }
  return nullptr;
}

std::string mend_for_list(std::string_view column, std::string_view cell) {
  const bool is_list =
      cell.size() > 1 && std::string_view("[({").find(cell.front()) != std::string_view::npos;
  return is_list ? fmt::format(
                       "a cell holds one number: write the list as columns, '{0}[0]', "
                       "'{0}[1]'",
                       column)
                 : std::string();
}

const Channel& Dataset::at(std::string_view channel_name) const {
  if (const Channel* channel = find(channel_name)) return *channel;
  const auto text = std::ranges::find(texts, channel_name, &TextCell::column);
  if (text != texts.end()) {
    std::string mend = mend_for_list(channel_name, text->text);
    if (mend.empty()) {
      mend = text->text.find(',') == std::string::npos
                 ? "name a column of numbers, or write numbers"
                 : "write numbers with a decimal point and without signs for thousands";
    }
    throw_bad_input(
        fmt::format("column '{}' holds text: '{}' is no number", channel_name, text->text),
        text->place, mend);
  }
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  throw_bad_input(fmt::format("there is no column '{}'", channel_name), name,
                  did_you_mean(channel_name, names));
}

ChannelIndex::ChannelIndex(const Dataset& data) : data_(data) {
  by_name_.reserve(data.channels.size());
  for (const Channel& channel : data.channels) by_name_.try_emplace(channel.name, &channel);
}

const Channel* ChannelIndex::find(std::string_view channel_name) const {
  const auto found = by_name_.find(channel_name);
  return found == by_name_.end() ? nullptr : found->second;
}

void cut_movements(Dataset& data, std::span<const std::size_t> first_rows) {
  std::vector<int> movement;
  std::vector<std::string> names;
  std::vector<std::size_t> part(data.movement_names.size(), 0);
  auto next = first_rows.begin();
  for (std::size_t r = 0; r < data.rows(); ++r) {
    const bool begins = next != first_rows.end() && *next == r;
    if (begins) ++next;
    if (r == 0 || begins || data.movement[r] != data.movement[r - 1]) {
      const auto of = static_cast<std::size_t>(data.movement[r]);
      names.push_back(fmt::format("{}, part {}", data.movement_names[of], ++part[of]));
    }
    movement.push_back(static_cast<int>(names.size()) - 1);
  }
  data.movement = std::move(movement);
  data.movement_names = std::move(names);
}

}  // namespace tribench
