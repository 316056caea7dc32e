// SPDX-License-Identifier: MIT
//
// Chooses among formulas of different size by cross-validation over whole movements, with the
// constants fitted anew on each training part. For choosing from a front that a search has found;
// the estimate is optimistic for the search itself, which saw all rows.
//
// Source: Hastie, Tibshirani & Friedman 2009, section 7.10. We differ from their one-standard-error
// rule in that the error compared is the paired difference to the best formula, fold by fold, whose
// standard error is far smaller than that of either.
//
// Where the formula will be used beyond the rows (the declared box is wider than their range), held
// out as well are the rows at the edge that it will be continued over: the best formula between the
// rows is often not the best beyond them (a square of the load, fitted to the unloaded arm). There
// a larger formula has to be better by two standard errors, not by one: what it adds is seen on the
// rows and trusted beyond them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

// What is held out where the box is wider than the rows: `edges`, the fifth of the rows farthest
// out on each such side, one side after the other; `as_far`, on all such sides at once, what lies
// as many times farther out than the rest as the box lies farther out than the rows. The second is
// nearer to what will be asked, and keeps to forms that are simple enough to be continued so far;
// of a search's own front, whose forms differ little beyond, the first.
enum class Beyond { edges, as_far };

struct CrossValidation {
  std::size_t chosen = 0;  // place among the formulas
  std::vector<double>
      mean_square;  // held-out mean squared error of each; infinite where not finite
  std::vector<std::vector<double>> fold_errors;  // of each, a mean square a fold
  std::uint64_t node_rows = 0;                   // what it cost
};

// Whether held-out mean squares, fold by fold, are larger than the best formula's by no more than
// chance would have it (one standard error of the paired difference), and nowhere twice as large.
bool as_good(std::span<const double> errors, std::span<const double> best, double tolerance = 1);

// True where the box is wider than the rows' range by more than a twentieth of it, for an input
// that varies and is not a sign.
bool reaches_beyond(const Inputs& inputs, const InputBox& box);

// Which fold each row is held out with: movements (the stretches of a single one; rows where none
// are named) are dealt out in a fixed random order.
std::vector<int> held_out_folds(std::span<const int> movement, std::size_t rows, int folds);

// formulas: by increasing complexity, at least one. All values finite; movement[r] names the
// movement of row r. Chosen is the simplest formula whose held-out error exceeds the smallest by
// less than one standard error of the paired difference (two where it reaches beyond), and is
// nowhere twice as large. The rows of
// a single movement are held out by stretches, in their order; with fewer than 20 of them the last
// formula is chosen. box: the ranges the formula will be used over; none given means those of the
// rows. A formula that leaves the band of a straight continuation somewhere in a wider box counts
// as infinite, as does one with as many numbers as a fold leaves rows to fit: it would know those
// held out by the constants that it came with. Of a fit to at most 20 rows an error counts at least
// the curve's own variance at those held out (fit_intervals.hpp). in_time: asked before each fit of
// a formula to a fold; once it says no, no error is known (mean_square is empty) and the last
// formula is chosen.
CrossValidation cross_validate(std::span<const Expression> formulas, const Inputs& inputs,
                               std::span<const double> target, std::span<const int> movement,
                               const InputBox& box = {}, int folds = 5,
                               const std::function<bool()>& in_time = {},
                               Beyond held_out_beyond = Beyond::edges);

// The first whose held-out mean square is at most a tenth above the least, of formulas by
// increasing complexity: with many rows every term is significant, and what it is worth beyond them
// nobody has seen. No standard error is asked: of folds one of which lies farther out than the rest
// it is as large as that one's difference, and forgives it.
std::size_t simplest_as_good(std::span<const double> mean_square);

}  // namespace tribench
