// SPDX-License-Identifier: MIT
//
// What a table without a short law has to say: a sum of many products of its inputs and of their
// distances from a few places (piecewise linear), chosen term by term, how many by folds in which
// the choice is made anew. One formula, linear in its numbers; no form is searched for, so that the
// held-out error is honest: what any other formula has to beat.
//
// Not for laws: a law that is found stands better and is shorter. Not beyond the rows, where
// products of distances grow as they like.
//
// Source: forward stepwise selection (Hastie, Tibshirani & Friedman 2009, 3.3) among the products
// of multivariate adaptive regression splines (Friedman 1991), with three places an input.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/finite_rows.hpp"

namespace tribench::relay {

struct LongSum {
  Expression formula;
  std::vector<double> held_out;  // mean squares, fold by fold, of choices that had not seen it
  double mean_held_out() const;
};

// Terms are chosen on at most `most_rows` rows, spread evenly, their coefficients fitted to all; at
// most one for four rows, and 150. Of more than eight inputs those that a sum of products of two
// takes first. None with fewer than 40 rows, where budget or seconds do not suffice, where no term
// predicts rows held out, and where the operators lack + - *. Cost: some 0.2 s for eight inputs and
// 4000 rows, 1.5 s for 24 000.
std::optional<LongSum> fit_long_sum(const FiniteRows& rows, const OperatorSet& operators,
                                    std::size_t most_rows, Budget& budget);

// Of a formula on the same rows and folds, its constants fitted anew without those held out: what a
// sum's errors are to be compared with. Infinite where it is not finite on a row. Cost: ten fits.
std::vector<double> held_out_errors(const Expression& formula, const FiniteRows& rows,
                                    std::size_t most_rows);

}  // namespace tribench::relay
