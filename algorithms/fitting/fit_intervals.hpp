// SPDX-License-Identifier: MIT
//
// How well the rows determine a formula's constants and its curve: 95 % intervals, given the form.
//
// The constants are taken to be at a least-squares minimum; the formula is linearised there. Where
// the rows come in enough movements, a movement is the unit of independence: the movements are
// left out one at a time (the jackknife, CR3 of Bell & McCaffrey 2002), t with movements - 1
// degrees of freedom. Else rows are taken to be independent with one variance, t with rows - rank
// degrees of freedom. That the form was searched for is not in them: they are too narrow where the
// rows hardly tell several forms apart.
//
// Whole exponents are part of the form, and so are whole numbers that the others can stand for: the
// 1 of 1 / (a + b x). A constant that the rows do not determine (a product of
// two) has no interval: NaN. Deterministic. Cost: one Jacobian and O(rows p^2 + movements p^3).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

struct ConstantInterval {
  double value = 0;
  double low = 0;  // NaN: not determined
  double high = 0;
};

struct FitIntervals {
  std::vector<std::size_t> places;          // of the constants on the tape
  std::vector<ConstantInterval> constants;  // in that order
  std::vector<double> covariance;           // p x p, by rows
  double quantile = 0;                      // of t, by which a standard error is multiplied
  std::string unit;                         // "movement" or "row"
  std::size_t units = 0;                    // those of a weight above 0
  std::string warning;                      // why rows are the units though they come in movements
};

// weights: of the squared residuals, relative; empty: all 1. known_variance: a weight is one over
// the variance of its row, which the residuals then say nothing about (rows as units only).
// Throws Error (bad_input) where there are no more rows than constants, or more than 1000 of these.
FitIntervals fit_intervals(const Expression& formula, const Inputs& inputs,
                           std::span<const double> target, std::span<const int> movement,
                           std::span<const double> weights = {}, bool known_variance = false);

// Half the width of the curve's interval in each row.
std::vector<double> curve_half_widths(const Expression& formula, const FitIntervals& intervals,
                                      const Inputs& inputs);

// The mean variance of the curve over `others` that the fitted rows leave: infinite where they are
// no more than the constants, and where what they do not determine moves the curve there, as an
// asymptote does that one row alone tells. 0 where a derivative is not finite: nothing is known.
double mean_curve_variance(const Expression& formula, const Inputs& fitted,
                           std::span<const double> target, const Inputs& others);

// The two-sided 95 % point of Student's t; 1e-3 at 3 degrees of freedom, 1e-5 from 6 on.
double student_point(double freedom);

}  // namespace tribench
