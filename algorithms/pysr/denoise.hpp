// SPDX-License-Identifier: MIT
//
// A smoothed target for the search to look at: the posterior mean of a Gaussian process trained on
// the measured rows. What is found is fitted, chosen and reported on the measured rows.
//
// Source: PySR, pysr/denoising.py: squared exponentials, white noise of 0.1 and a constant, by
// maximum likelihood from 50 restarts. Ours differs in that the function's variance is free (there
// it is 1, whatever the target's unit), rows and target are standardised, and the rows are bounded:
// covariances are chosen on kCovarianceRows, the mean stands on kTrainingRows, both drawn.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/pysr/rows.hpp"
#include "foundation/random.hpp"

namespace tribench::pysr {

inline constexpr std::size_t kCovarianceRows = 200;
inline constexpr std::size_t kTrainingRows = 1000;

struct Denoised {
  std::vector<double> target;  // at the rows that were asked for, in the target's unit
  double noise = 0;            // its standard deviation as the process has it, same unit
};

// Trained on `measured`, asked at `wanted`, as a function of the columns named. None where the
// budget does not reach (then nothing is spent) or no covariance can be factored.
std::optional<Denoised> denoised(const Rows& measured, const Rows& wanted,
                                 std::span<const std::size_t> columns, RandomStream random,
                                 Budget& budget);

}  // namespace tribench::pysr
