// SPDX-License-Identifier: MIT
//
// Which of many fitted formulas to choose: one near their mean under the posterior.
//
// Where noise leaves a dozen forms within two nats of each other, the one with the most evidence is
// often the one that fits the noise best. The mean of the forms' values, weighted by
// exp(-negative log evidence), fits it less; a formula's mean squared distance from that mean is,
// but for a constant, its expected squared error under the posterior. A formula no farther from it
// than the forms are on average cannot be told from one of them.
//
// Source: Bayesian model averaging, Hoeting et al. 1999; one model for the mean, Barbieri & Berger
// 2004. We differ in that forms that are the same function on the rows count once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

// Formulas so many nats behind the best have no weight that matters: exp(-15) is 3e-7.
inline constexpr double kNegligibleNats = 15;

struct WeighedFormula {
  const Expression* formula = nullptr;
  double against = 0;      // negative log evidence, nats; evidence.hpp
  double mean_square = 0;  // error on the rows
};

struct PosteriorDistances {
  std::vector<double> mean_square;  // per candidate; infinite where it is not finite
  double spread = 0;                // the weighted mean of the pool's own distances
  std::uint64_t node_rows = 0;      // evaluated
};

// The candidates' mean squared distances from the posterior mean of `pool`, which holds the
// candidates among others and may hold a formula twice. Formulas kNegligibleNats behind the
// best are left out. On at most 1000 rows, spread evenly. An empty pool: all
// infinite.
PosteriorDistances distances_from_posterior_mean(std::span<const Expression> candidates,
                                                 std::span<const WeighedFormula> pool,
                                                 const Inputs& inputs);

// The first candidate no farther than the spread, of candidates by increasing complexity; where
// there is none, the nearest.
std::size_t simplest_typical(const PosteriorDistances& distances);

}  // namespace tribench
