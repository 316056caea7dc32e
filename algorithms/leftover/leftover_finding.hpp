// SPDX-License-Identifier: MIT
//
// What no family explains: where it lives and what it looks like.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tribench::loop {

struct CurvePoint {
  double x = 0;
  double y = 0;
  double error = 0;
};

// What repeats along the position with a period that nobody has named.
struct RepeatingFinding {
  double wavenumber = 0;   // 2 pi over its length in rad or m: the gear's ratio were it the motor's
  double mean_square = 0;  // of its torque, told on movements left out
};

// A term whose coefficient differs from movement to movement though no signal says why.
struct VaryingFinding {
  struct OfMovement {
    int movement = 0;
    std::string movement_name;
    // Root mean square of its own part of the term, with the sign of the coefficient where the term
    // has but one; in the target's unit.
    double torque = 0;
  };
  std::string term;  // "coulomb_friction", "viscous_friction" or a family
  double share = 0;  // of what is left about the movements' means: what it foretells of it
  std::vector<OfMovement> movements;
};

struct LeftoverFinding {
  bool tested = false;  // enough stretches carry a smooth function of some signal
  double p = 1;
  double gain = 0;  // nats that the best function of its inputs adds on movements left out
  // Role names, or "movement" where it lives in no signal (varying); empty where nothing is left.
  std::vector<std::string> inputs;
  std::vector<std::string> signals;  // the same as signals; empty beside "movement"
  // Without inputs it is a doubt: too few movements to be sure, too much to be passed over.
  std::optional<VaryingFinding> varying;
  bool is_in_doubt() const { return varying && inputs.empty(); }
  std::optional<RepeatingFinding> repeating;
  std::vector<std::string> proxies_removed;
  // Share of the searches with some movements left out that leave something over, too; NaN where
  // there are none.
  double chosen_share = std::numeric_limits<double>::quiet_NaN();
  std::vector<CurvePoint> curve;  // over the one input
};

}  // namespace tribench::loop
