// SPDX-License-Identifier: MIT
//
// How small an error these data allow, where nobody knows the noise: two bounds.
//
//   floor       mean |e''| / sqrt(6) of the residual's second differences within movements, e''
//   being
//               e_before - 2 e + e_after: what changes slower than three rows cancels. Noise that
//               lasts from row to row cancels in part too, so the noise is no smaller than this.
//   attainable  the mean absolute held-out error with a smoother in every input added to the model:
//   some
//               model of these inputs does get there, so the noise is no larger.
//
// Source: von Neumann et al. 1941 (differences); specification, 3.10. Cost: one Gram matrix of some
// 200 columns and a few solves of it.
#pragma once

#include <span>
#include <vector>

#include "harness/loop/loop_judge.hpp"

namespace tribench::loop {

// What smooth functions of each input (times 1 and the direction) explain of a residual: ridge
// regression on the rows with train[i] != 0, its penalty chosen by leaving out movements among them
// (no correction at all being one choice). Of all rows; deterministic given random.
Eigen::VectorXd smooth_correction(const Observations& data, const std::vector<char>& train,
                                  const Eigen::VectorXd& residual, RandomStream random);

// Fills in the error's bounds and the share of the gap that was closed, with a 95 % bootstrap over
// units. before, after, corrected: errors of the judged rows. Leaves NaN and says why in
// error.ceiling_note where there is no gap or too little to tell.
void bound_noise(ErrorFinding& error, const Observations& judged, const Eigen::VectorXd& before,
                 const Eigen::VectorXd& after, const Eigen::VectorXd& corrected,
                 std::span<const int> unit, RandomStream random);

}  // namespace tribench::loop
