// SPDX-License-Identifier: MIT
#include "problems/campaign_channels.hpp"

#include <array>
#include <utility>

namespace tribench {

std::string channel_name(Role role, std::string_view unit) {
  std::string name = std::string(role_name(role)) + '_';
  for (const char c : unit) {
    if (c == '/') name += '_';
    if (c != '/' && c != ' ' && c != '^') name += c;
  }
  return name;
}

Dataset blank_campaign(std::string name) {
  Dataset data;
  data.name = std::move(name);
  const auto add = [&](Role role, const char* unit) {
    data.channels.push_back({channel_name(role, unit), unit, role, {}});
  };
  add(Role::time, "s");
  add(Role::position, "rad");
  add(Role::velocity, "rad/s");
  add(Role::acceleration, "rad/s^2");
  add(Role::gravity_torque, "N m");
  add(Role::temperature, "degC");
  add(Role::other_velocity, "rad/s");
  add(Role::other_acceleration, "rad/s^2");
  return data;
}

void append_campaign_row(Dataset& campaign, int movement, const CampaignRow& row) {
  const std::array values = {row.time_s,
                             row.position_rad,
                             row.velocity_rad_s,
                             row.acceleration_rad_s2,
                             row.gravity_nm,
                             row.temperature_degc,
                             row.other_velocity_rad_s,
                             row.other_acceleration_rad_s2};
  for (std::size_t c = 0; c < values.size(); ++c) {
    campaign.channels[c].values.push_back(values[c]);
  }
  campaign.movement.push_back(movement);
}

}  // namespace tribench
