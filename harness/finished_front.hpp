// SPDX-License-Identifier: MIT
//
// A method's front as it is judged: every formula in its shortest form (fitting/finish.hpp), each
// once, and the exact one chosen where the rows have no noise (fitting/exact_choice.hpp). Else
// those that are far away between the rows are left out where a simpler one is as good on them
// (fitting/crossed_rows.hpp), and another is chosen where the rows are fewer than two for each of
// the choice's numbers, or few and speak plainly against it (fitting/held_out_choice.hpp). A plain
// sum takes its place only in a method that says so (FitResult::yields_to_plain_sum). The one place
// between methods and judge where formulas are rewritten and a choice is looked at again; a method
// that was given a form by the user keeps it (FitResult::keeps_form), and a program of the user's
// its choice (keeps_choice).
#pragma once

#include "algorithms/finite_rows.hpp"
#include "algorithms/regressor.hpp"

namespace tribench {

// Of the seconds of a fit on few rows, what its search may take; the rest is for the look at its
// choice, which leaves the choice as it is once the seconds have run out.
inline constexpr double kSearchShareOfFewRows = 0.9;

// A form that has a number for every other row meets the rows whatever the law, and their number is
// too small for rows left out to show it: where that is the choice, the likeliest of those with
// fewer numbers takes its place.
void leave_saturated(const FiniteRows& rows, FitResult& fit);

// Changes `fit.front` and `fit.chosen`. Formulas are finished on the finite rows of `data`.
void finish_front(const TrainingData& data, const OperatorSet& operators, Budget& budget,
                  FitResult& fit);

}  // namespace tribench
