// SPDX-License-Identifier: MIT
//
// The channels that a generated campaign records of a joint whose friction has causes beyond the
// velocity, and a row of them. What is added to them (friction, planted effects) is the campaign's.
#pragma once

#include <string>
#include <string_view>

#include "problems/dataset.hpp"

namespace tribench {

// Of one instant, in SI; the other joint is the one beside it in the arm.
struct CampaignRow {
  double time_s = 0;  // of the campaign
  double position_rad = 0;
  double velocity_rad_s = 0;
  double acceleration_rad_s2 = 0;
  double gravity_nm = 0;
  double temperature_degc = 0;
  double other_velocity_rad_s = 0;
  double other_acceleration_rad_s2 = 0;
};

// What our files call a quantity: its role and its SI unit, "velocity_rad_s".
std::string channel_name(Role role, std::string_view unit);

// A channel a member, in their order, without rows.
Dataset blank_campaign(std::string name);
void append_campaign_row(Dataset& campaign, int movement, const CampaignRow& row);

}  // namespace tribench
