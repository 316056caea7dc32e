// SPDX-License-Identifier: MIT
//
// The rigid body in a motor torque or current: inertia times acceleration, and gravity of one
// joint, A sin q + B cos q, where no column declares it. Fitted beside Coulomb and viscous
// friction, which are not returned: the diagnosis has its own.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "problems/dataset.hpp"

namespace tribench {

// Neighbouring rows repeat one another: of this many only one is new to the standard errors.
inline constexpr double kRowsThatAgree = 20;

// A column that the others explain to this share of its size says nothing of its own.
inline constexpr double kDependent = 1e-6;

// The motor's torque or, where none was recorded, its current; null without both.
const Channel* effort_of(const Dataset& data);

struct RigidBody {
  double sine = 0;  // coefficients of sin q and cos q, in the torque's unit
  double cosine = 0;
  double explained = 0;  // share of what friction and inertia leave that gravity takes
  double certainty = 0;  // amplitude over its standard error
  double friction = 0;   // at the typical speed, with its sign: negative opposes convention
  double friction_error = 0;
};

// Needs an angle, a velocity and a torque (motor_torque or motor_current); acceleration where there
// is one. Nothing where one of them is missing or rows are too few to tell.
std::optional<RigidBody> fit_rigid_body(const Dataset& data);

// The factor by which a declared gravity torque goes into the motor torque while the joint moves:
// 1 where both have one unit and one sign. The standard error is at least what the estimate changes
// by where an eighth of the rows is left out (jackknife): a gravity that varies in one stretch
// alone, or that is too small to be seen, tells no factor. Nothing where it hardly varies.
struct GravityFactor {
  double value = 1;
  double error = 0;
  double explained = 0;  // share of what friction and inertia leave that gravity takes
};
std::optional<GravityFactor> gravity_factor(const Dataset& data);

// What a smoother takes off an acceleration that changes fast is, to first order, a share of what
// it takes off when it has half the bandwidth; the torque tells the share. Below 0 its noise
// outweighs that: at -1 half the bandwidth is right. `change`: the acceleration less the one of
// half the bandwidth, per row. With its standard error; nothing where the torque says nothing of
// it.
struct Blunting {
  double share = 0;
  double error = 0;
};
std::optional<Blunting> acceleration_blunting(const Dataset& data, std::span<const double> change);

// The change of acceleration that the torque would show: its noise, in means as a diagnosis takes
// them, divided by the inertia that it tells. Nothing where it tells none.
std::optional<double> visible_acceleration(const Dataset& data);
// The change of velocity that a friction torque would show.
std::optional<double> visible_velocity(const Dataset& data);

// Of two tellings of one motion, the recording's own and another, the one that the torque goes
// with: in standard errors, above 0 the other. What friction, a motor's inertia and gravity leave
// of the torque is less with it, as the eighths of the recording agree. Nothing where no torque was
// recorded or rows are too few.
std::optional<double> torque_prefers(const Dataset& data, std::span<const double> velocity,
                                     std::span<const double> acceleration);

}  // namespace tribench
