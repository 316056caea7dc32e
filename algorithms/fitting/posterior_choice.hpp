// SPDX-License-Identifier: MIT
//
// Which of many fitted formulas to stand for: one that is near to what all of them say together,
// each as loud as its evidence.
//
// Where noise lets a dozen forms within two nats of each other, the one with the most evidence is
// often the luckiest. The mean of the forms' values, weighted by exp(-evidence against), has less
// of that luck; a formula's mean squared distance from it is, but for a constant, its expected
// squared error under the posterior. A formula no farther from it than the forms are on average
// cannot be told from one of them.
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

struct WeighedFormula {
  const Expression* formula = nullptr;
  double against = 0;      // nats; evidence.hpp
  double mean_square = 0;  // error on the rows
};

struct PosteriorDistances {
  std::vector<double> mean_square;  // per candidate; infinite where it is not finite
  double spread = 0;                // the weighted mean of the pool's own distances
  std::uint64_t node_rows = 0;      // what finding out cost
};

// The candidates' mean squared distances from the posterior mean of `pool`, which holds the
// candidates among others and may hold a formula twice. Formulas with less than exp(-15) of the
// best one's weight are not asked. On at most 1000 rows, spread evenly. An empty pool: all
// infinite.
PosteriorDistances distances_from_posterior_mean(std::span<const Expression> candidates,
                                                 std::span<const WeighedFormula> pool,
                                                 const Inputs& inputs);

// The first candidate no farther than the spread, of candidates by increasing complexity; where
// there is none, the nearest.
std::size_t simplest_typical(const PosteriorDistances& distances);

}  // namespace tribench
