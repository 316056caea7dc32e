// SPDX-License-Identifier: MIT
//
// Whether a friction formula with states can only take energy from the joint.
//
// A formula that remembers stores energy too, so that f v >= 0 at every point is too much to ask:
// a bristle gives back what it took. The claim is that of dissipative systems: there is a stored
// energy V >= 0 of the states with f v >= dV/dt along every motion that stays in the box.
//
//   proved   with V' = k z + d |z|, the terms of the formula in a bristle's deflection alone
//            (|d| <= k): then f v - dV/dt >= (f - those terms) v, which prove_property decides, or
//            with what the sliding bristles of dahl and lugre take, |v| (k z^2 + d z |z|) / g(v).
//            For LuGre's s0 z + s1 z' + s2 v that is s2 >= s1 (Fs - Fc) / Fc at every speed, the
//            condition of Barahanov & Ortega 2000 (IEEE TAC 45, 328), and less where the box is
//            small.
//   refuted  by a cycle: velocities held in turn after which every state is what it was, and the
//            joint has been given energy. No V can explain that.
//   undecided otherwise: also where formulas hold gms or backlash states that add to the force.
//
// Source of the condition: Canudas de Wit et al. 1995, section III; Barahanov & Ortega 2000.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/property.hpp"
#include "algorithms/states/state_text.hpp"

namespace tribench {

struct WorkLeg {
  double velocity = 0;
  double seconds = 0;
};

struct DissipationResult {
  Verdict verdict = Verdict::undecided;  // proved_free stands for proved
  std::vector<WorkLeg> cycle;            // refuted: other inputs in the middle of their ranges
  double work = 0;                       // done on the joint's motion in one cycle, below 0
  std::vector<Interval> undecided_box;
  std::size_t boxes = 0;
};

// box: of the formula's columns, states included (parse_stateful_over). Throws as prove_property.
DissipationResult prove_dissipation(const StatefulFormula& formula, const InputBox& box,
                                    std::size_t velocity, const ProofLimits& limits = {});

// {"cycle":[{"v":0.1,"seconds":0.2},...],"work":-0.03}
std::string work_cycle_json(const DissipationResult& result, const std::string& velocity);

}  // namespace tribench
