// SPDX-License-Identifier: MIT
//
// What a simulated joint and its recorder have in common whoever lays the movements out: how it
// warms, what it feels at an instant, which channels are written down, friction without a cause.
// Internal to the room.
#pragma once

#include <span>
#include <vector>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"
#include "problems/joint_simulation/causes.hpp"
#include "problems/joint_simulation/motion.hpp"

namespace tribench::simulation {

inline constexpr double kMovementOffset = 0.15;  // sd of the movements' offsets, in sd of the noise

// Motion warms the lubricant, the lubricant warms the housing with its sensor.
class Thermal {
 public:
  Thermal(double oil_s, double housing_s) : oil_s_(oil_s), housing_s_(housing_s) {}
  void advance(double speed_rad_s, double dt_s);
  double oil_degc() const { return oil_; }
  double sensor_degc() const;

 private:
  double oil_s_;
  double housing_s_;
  double oil_ = kCoolest_degc;
  double housing_ = kCoolest_degc;
};

// Its time constants are parts of a campaign that lasts so long.
Thermal draw_thermal(double campaign_s, RandomStream random);

// The state t_s after the movement's start; `part` and the oil's temperature are the caller's.
Instant instant_of(const Movement& movement, double t_s);

// To a campaign as blank_campaign (problems/campaign_channels.hpp) begins it.
void append_row(Dataset& data, int movement, double time_s, const Instant& now, double sensor_degc);

// Coulomb and viscous friction by direction, drawn from the stream: the same stream, the same
// joint. [N m], a value a velocity in rad/s.
std::vector<double> base_friction(std::span<const double> velocity, RandomStream random);

double root_mean_square(std::span<const double> values);

}  // namespace tribench::simulation
