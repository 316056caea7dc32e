// SPDX-License-Identifier: MIT
//
// The kinds of mutation that change a formula without looking at data, how one is drawn, and
// crossover. Source: SymbolicRegression.jl, MutationFunctions.jl and Mutate.jl.
#pragma once

#include <optional>
#include <utility>

#include "algorithms/pysr/options.hpp"
#include "algorithms/pysr/random_formula.hpp"

namespace tribench::pysr {

// The weights with what makes no sense for this parent taken out: a leaf has no operator to
// mutate, swap or delete, a formula without constants none to move, and so on.
MutationWeights conditioned(const MutationWeights& weights, const Expression& parent,
                            int parent_size, int max_size, std::size_t inputs);

// Proportional to the weights; do_nothing where all are 0.
MutationKind draw_kind(const MutationWeights& weights, RandomStream& random);

// What a structural mutation needs to know.
struct MutationSettings {
  double temperature = 1;
  double perturbation_factor = 0.129;
  double negate_probability = 0.00743;
  bool compat = false;  // flips the sign with 1 - negate_probability, as the original does
  int max_size = 30;    // for randomize
};

// A changed copy of the parent; none where the kind does not apply. Constraints are the caller's.
// Only the kinds from rotate_tree to randomize except simplify, and do_nothing.
std::optional<Expression> mutate(MutationKind kind, const Expression& parent,
                                 const Alphabet& alphabet, const MutationSettings& settings,
                                 RandomStream& random);

// The factor of a mutation of a constant: (perturbation * T + 1.1)^u, inverted with even chances,
// negated as the settings say.
double constant_factor(const MutationSettings& settings, RandomStream& random);

// Two uniformly drawn subtrees change places.
std::pair<Expression, Expression> cross(const Expression& a, const Expression& b,
                                        RandomStream& random);

}  // namespace tribench::pysr
