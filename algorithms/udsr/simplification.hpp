// SPDX-License-Identifier: MIT
//
// Recursive simplification in AI-Feynman's sense: finds that a function of several inputs is made
// of functions of fewer, so that each can be searched for alone.
//
// Source: Udrescu & Tegmark 2020, sections 2.5-2.7: four translational symmetries and two
// separabilities. The original always takes the best of the six and recurses; we accept one only
// if its error is at most twice the smoother's held-out error AND both parts are shown to matter by
// a permutation test. The unreduced problem is always searched too.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/expression/operator_set.hpp"
#include "algorithms/regressor.hpp"
#include "algorithms/udsr/smoother.hpp"

namespace tribench::udsr {

enum class ReductionKind { difference, sum, ratio, product, additive, multiplicative };

struct Reduction {
  ReductionKind kind = ReductionKind::additive;
  double error = 0;  // median absolute error of the reduced function, in the target's unit
  // Symmetries: the two inputs that enter only as first op second.
  std::size_t first = 0;
  std::size_t second = 0;
  // Separabilities: the inputs of the one part; the rest are the other's.
  std::vector<std::size_t> part;
};

// The accepted reduction with the smallest error, if any. An input and its sign stay together and
// take no part in symmetries. `allowed` says which operations may recombine the parts. None where
// the seconds run out.
std::optional<Reduction> find_reduction(const Smoother& smoother, std::span<const Input> inputs,
                                        const OperatorSet& allowed, RandomStream random,
                                        Budget& budget);

// A problem of its own: inputs, columns and target that a search can be run on, and how its
// formula goes back into the original inputs.
struct Subproblem {
  std::vector<Input> inputs;
  std::vector<std::vector<double>> columns;
  std::vector<double> target;
  std::vector<Expression> substitutes;  // input j of the subproblem, in the original's inputs
};

// The parts a reduction leaves: one for a symmetry, two for a separability.
std::vector<Subproblem> split(const Reduction& reduction, const Smoother& smoother,
                              const TrainingData& data);

// The original's formula from the parts'.
Expression recombine(const Reduction& reduction, std::span<const Subproblem> parts,
                     std::span<const Expression> formulas);

}  // namespace tribench::udsr
