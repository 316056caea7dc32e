// SPDX-License-Identifier: MIT
//
// Why friction is not what Coulomb and viscous friction say: physics with a memory, integrated in
// time along the motion. Shapes and constants are drawn anew for every campaign, so that no library
// of effects can be settled on them.
//
// Sources: Dahl 1968 (presliding); Canudas de Wit, Olsson, Astrom, Lischinsky 1995 (LuGre); Hess,
// Soom 1990 (friction lags its velocity); Armstrong-Helouvry, Dupont, Canudas de Wit 1994 (survey).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "foundation/random.hpp"
#include "problems/dataset.hpp"
#include "problems/joint_simulation/motion.hpp"

namespace tribench::simulation {

inline constexpr double kGearRatio = 100;
inline constexpr double kCoolest_degc = 24;

struct Instant {
  double part = 0;           // of the campaign's time, 0 to 1
  std::size_t movement = 0;  // of the campaign
  MotionState joint;
  MotionState other;
  double gravity_nm = 0;
  double gravity_amplitude_nm = 0;
  double gravity_phase_rad = 0;
  double oil_degc = kCoolest_degc;  // the lubricant's; the sensor's lags behind
  double sign() const { return joint.velocity_rad_s > 0 ? 1 : joint.velocity_rad_s < 0 ? -1 : 0; }
};

// The torque, in a unit of its own, after dt_s more seconds in this state; called in order.
using Response = std::function<double(const Instant& now, double dt_s)>;

struct Cause {
  std::string_view name;
  std::string_view summary;
  // Families of effects (as in loop.json) that name it; empty: no library has it, a diagnosis must
  // answer UNKNOWN.
  std::vector<std::string> names;
  std::vector<std::string> beside;  // that may stand beside one of these: part of the same physics
  std::vector<Role> lives_in;
  bool needs_reversals = false;  // cannot be seen in movements one way
  Response (*start)(RandomStream random) = nullptr;
  bool has_bristles = false;  // friction that builds up with the way: presliding
  // A world draws its truth from its seed: one cause more to draw from and every sealed world would
  // hide something else.
  bool in_worlds = true;
};

// What a small way from rest adds to a response with bristles that starts anew, per rad: their
// stiffness, in the response's own unit.
double relaxed_stiffness(const Response& response);

const std::vector<Cause>& causes();
// Throws Error (bad_input) with the nearest name.
const Cause& find_cause(std::string_view name);

}  // namespace tribench::simulation
