// SPDX-License-Identifier: MIT
//
// Physics of a friction formula, decided by proof over a box: proved, refuted by a witness, or
// undecided. The claims are about the formula's real value at every point of the box whose signs
// agree with their inputs; a formula that is not proved finite has no property proved.
//
//   dissipative  f * v >= 0: friction never drives the joint
//   bounded      |f| <= limit
//   monotone     f(v1, ...) <= f(v2, ...) for all v1 < v2 with |v1| and |v2| >= from, whatever
//                their signs: beyond the Stribeck range friction grows with speed, and no jump of
//                a sign goes down. What happens at |v| < from, a pole too, is not asked.
//   odd          f(-v, ...) = -f(v, ...), signs of v turned with it: no direction is preferred
//
// Method: branch and bound with the bounds of bounds.hpp on cells closed at v = 0 (f's limit there
// decides nothing but a limit that has the wrong sign); monotony by the slope on v < 0 and v > 0
// and by the steps between them; oddness by canonical forms.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/singularity.hpp"

namespace tribench {

enum class Property { finite, bounded, dissipative, monotone, odd };
std::string_view property_name(Property property);

struct PropertyQuestion {
  Property property = Property::dissipative;
  std::size_t velocity = 0;  // place of v among the inputs
  double limit = kInfinity;  // bounded: in the formula's unit
  double from = 0;           // monotone: in v's unit
};

struct PropertyResult {
  Verdict verdict = Verdict::undecided;  // proved_free stands for proved
  // Refuted: a point where f v < 0 or |f| > limit; two points, v growing and f falling (monotone)
  // or mirrored with f(-v) != -f(v) (odd); or the witness of a singularity.
  std::optional<Witness> witness;
  std::vector<Interval> undecided_box;
  std::size_t boxes = 0;
};

// Throws Error (bad_input) on a box that is none, a velocity that is no input with a range, or a
// question about no point of the box (monotone from beyond the largest speed).
PropertyResult prove_property(const Expression& formula, const InputBox& box,
                              const PropertyQuestion& question, const ProofLimits& limits = {});

}  // namespace tribench
