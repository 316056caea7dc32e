// SPDX-License-Identifier: MIT
//
// Whether the coefficient of some term differs from movement to movement (random slopes, beside the
// random intercept of noise.hpp): a load that was changed, grease that ran warm, and no column that
// says so. Tests that leave out whole movements cannot see it, as no other movement tells a
// movement's own coefficient; other parts of the same movement do.
//
// Each movement is cut into five parts. What its own coefficients, fitted to the others (rows
// nearer than two correlation times left out), foretell of a part better than the mean of those
// rows does is the term's gain there, as a share of the squared error: a loud movement says no more
// than a quiet one. Beside noise alone gains are below 0 on the average; their signs are flipped by
// movement, all terms together, and the largest is compared with the largest under flips. So fewer
// than nine movements can say nothing at a level of 0.002.
//
// Not for one movement that is unlike all others (bursts.hpp): flips of one sign say nothing.
//
// Source: Laird and Ware 1982 (random coefficients); Burman, Chow and Nolan 1994 (rows near the
// part left out take no part); Westfall and Young 1993 (max statistic).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/inference/clusters.hpp"
#include "foundation/random.hpp"

namespace tribench::loop {

// Of one term.
struct RandomSlopes {
  // Of the squared error about the movements' own means, what is foretold: the mean of the
  // movements' shares, which is tested, and the share of all squares.
  double mean_share = 0;
  double share = 0;
  double p = 1;  // against the largest mean share of all terms
  // movements x columns of the term: each movement's own coefficients, less nothing that is common
  // to them (the residual's model has that).
  Eigen::MatrixXd slopes;
};

// terms: of each the columns, rows x a few, finite. residual: of a model that has all terms
// already. flips: how many. Movements that leave fewer than ten rows to fit to gain nothing. As
// many as there are terms. Cost: rows x columns^2 of each term.
std::vector<RandomSlopes> random_slopes(std::span<const Eigen::MatrixXd> terms,
                                        const Eigen::VectorXd& residual,
                                        std::span<const RowRange> movements, std::size_t flips,
                                        RandomStream random);

}  // namespace tribench::loop
