// SPDX-License-Identifier: MIT
//
// Whether a formula has a finite value everywhere in a box, decided by proof.
//
//   const InputBox box = {{-2, 2}, {-1, 1, 0}};         // v and sgn_v, the sign of input 0
//   const SingularityResult result = prove_free(formula, box);
//   result.verdict;                                     // proved_free, refuted, undecided
//
// Singular means: our evaluator, in double precision, yields a value that is not finite at a double
// of the box, intermediate results included (overflow, 0/0, log of 0); or a divisor, the operand of
// a log, or a factor of one, changes its sign between two neighbouring doubles where it is
// continuous: a pole that no double hits.
// `proved_free` claims that neither happens, for the values that the evaluator computes and for the
// real ones alike (but for the inside of a jump of sgn that no double hits). It is about the tape
// as given: constants are the doubles they are.
//
// Method: inputs that come with their sign (an input with sign_of, or one below sgn or abs) are
// split into < 0, 0 and > 0; then branch and bound with the bounds of bounds.hpp, looking for a
// witness in every box that does not pass. Deterministic unless the limit in seconds is met; one
// thread; reentrant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/interval.hpp"

namespace tribench {

enum class Verdict { proved_free, refuted, undecided };
std::string_view verdict_name(Verdict verdict);

// A point at which a node is not finite; with a neighbour, two points that differ in one input by
// one ulp and between which the node, a divisor or a factor of one, changes its sign.
struct Witness {
  std::vector<double> point;
  std::vector<double> neighbour;  // empty, or the second point
  std::size_t node = 0;           // place in the tape
};
// {"v": 0.3, "g": 1} or {"between": [{...}, {...}]}; {"points": [...]} for two points that are no
// neighbours, which refute a property.
std::string witness_json(const Witness& witness, std::span<const std::string> names);

struct ProofLimits {
  // Nodes bounded, over all boxes; what makes verdicts reproducible. The default is met in well
  // under a second.
  std::uint64_t node_boxes = 2'000'000;
  double seconds = 0;  // of wall time, a safety net; 0: none
};

struct SingularityResult {
  Verdict verdict = Verdict::undecided;
  std::optional<Witness> witness;       // where refuted
  std::vector<Interval> undecided_box;  // where undecided: the smallest such box, per input
  std::size_t boxes = 0;                // boxes bounded
};

// Throws Error (bad_input) where the box is not one (NaN, infinite, low > high, sign_of out of
// range) or lacks a column of the formula. Where the box has too many sign cells only its bounds as
// a whole are looked at: proved or undecided.
SingularityResult prove_free(const Expression& formula, const InputBox& box,
                             const ProofLimits& limits = {});

// All of the box, as ranges per input; a sign may be any.
std::vector<Interval> whole_box(const InputBox& box);

// The parts of the box in which every sign is one number, as ranges per input: the cells of the
// case split, in a fixed order. Each input whose sign the formula looks at makes three of one:
// empty where they would hold more than kMostSides ranges. Throws as prove_free.
inline constexpr std::size_t kMostSides = std::size_t{1} << 22;
std::vector<std::vector<Interval>> sign_cells(const Expression& formula, const InputBox& box);

}  // namespace tribench
