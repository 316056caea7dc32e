// SPDX-License-Identifier: MIT
//
// `bam_m1` .. `bam_m6`: the extended friction models of servo actuators, each more than the one
// before: Coulomb and viscous (1), Stribeck (2), friction from load (3), both (4), load by its
// direction (5), a quadratic share of the weaker side (6).
//
//   F = Kv |v| + Kc + e Kcs + |Km tm + Ke g| + e |Kms tm + Kes g| + e (Kqe g^2 or Kqm tm^2)
//   e = exp(-|v / vs|^alpha);   M3: Km = Ke;  M4: Kms = Kes too
//   torque = J a + k g + sgn(v) F + offset
//
// Source: Duclusaud, Passault, Padois, Ly, "Extended Friction Models for the Physics Simulation of
// Servo Actuators", ICRA 2025, models M1 to M6; their bam/model.py decides what the text leaves
// open (M6: the square of the smaller torque, only where motor and load oppose each other).
//
// Where ours differ. (a) g is the torque that the motor must hold: minus their external torque.
// (b) Their simulator knows the motor torque tm; a torque that is to be predicted is not known, so
// that tm = J a + g + sgn(v) F is solved for F: exactly where the two absolute values keep the
// signs that they have at F without load, the quadratic share is taken there. (c) They fit by
// simulated angles with CMA-ES, we fit torques by least squares from a grid of starts; bounds are
// theirs (K >= 0, 1 <= alpha <= 10) but vs, up to the top speed, and Km, Kms <= 0.45 (F exists).
//
// Static: they need no time. M3 to M6 refuse data without an input with role gravity_torque.
#pragma once

#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench {

std::vector<AlgorithmEntry> bam_entries();

}  // namespace tribench
