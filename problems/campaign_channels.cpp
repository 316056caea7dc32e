// SPDX-License-Identifier: MIT
#include "problems/campaign_channels.hpp"

#include <array>
#include <utility>

namespace tribench {

Dataset blank_campaign(std::string name) {
  Dataset data;
  data.name = std::move(name);
  data.channels = {{"time_s", "s", Role::time, {}},
                   {"position_rad", "rad", Role::position, {}},
                   {"velocity_rad_s", "rad/s", Role::velocity, {}},
                   {"acceleration_rad_s2", "rad/s^2", Role::acceleration, {}},
                   {"gravity_torque_Nm", "N m", Role::gravity_torque, {}},
                   {"temperature_degC", "degC", Role::temperature, {}},
                   {"other_velocity_rad_s", "rad/s", Role::other_velocity, {}},
                   {"other_acceleration_rad_s2", "rad/s^2", Role::other_acceleration, {}}};
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
