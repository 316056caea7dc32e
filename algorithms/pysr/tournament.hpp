// SPDX-License-Identifier: MIT
//
// Who becomes a parent, and whether a child may stay. Not for making the child (offspring.hpp).
#pragma once

#include <span>
#include <vector>

#include "algorithms/pysr/member.hpp"
#include "algorithms/pysr/options.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

// The place, among `contestants` ranked from best (0) on, that wins: rank r with probability
// p (1 - p)^r, renormalised.
std::size_t draw_rank(std::size_t contestants, double p, RandomStream& random);

// The index of the winner of one tournament among `members` (not empty). The adjusted cost is
// cost * exp(adaptive_parsimony * normalised frequency of the size).
// Source: SymbolicRegression.jl, Population.jl. O(tournament size).
std::size_t run_tournament(std::span<const Member> members, const SizeFrequencies& frequencies,
                           const Options& options, RandomStream& random);

// The index of the member with the smallest birth.
std::size_t oldest_of(std::span<const Member> members);

// The probability with which a child replaces the oldest member: the annealing factor
// exp(-(cost_child - cost_parent) / (temperature * alpha)) times the ratio of frequencies
// f(parent) / f(child), 1e-6 standing for a size out of range. May exceed 1. At temperature 0 it
// is 0 for a worse child, infinite for a better one and NaN for an equal one.
double acceptance(double cost_child, double cost_parent, int size_child, int size_parent,
                  double temperature, const SizeFrequencies& frequencies, const Options& options);

// A draw against it; a NaN compares false and so accepts, as in the original.
inline bool accepts(double probability, RandomStream& random) {
  return !(probability < random.uniform());
}

}  // namespace tribench::pysr
