// SPDX-License-Identifier: MIT
//
// Computes every figure of a formula: errors on train and test rows, distance from the true law,
// complexity, singularity, evaluation time. A method never scores itself.
#pragma once

#include <span>
#include <vector>

#include "algorithms/expression/expression.hpp"
#include "problems/problem.hpp"
#include "reports/record/record.hpp"

namespace tribench {

// A formula over all the problem's inputs, put together from its stages.
struct StagedFormula {
  Expression formula;
  Expression adaptation;  // the part of the second stage alone; empty where there is none
};

// Fills the errors of `record` for what is predicted in the rows that were fitted and in those that
// test. Without a finite value at a test row the record has failed and says at how many.
void judge_predictions(const Problem& problem, std::span<const double> train,
                       std::span<const double> test, Record& record);

// Fills the figures of `record` for the formula the cell stands for. Where the formula has no
// finite value at a test row the record has failed and says at how many.
void judge_formula(const Problem& problem, const StagedFormula& formula, Record& record);

// The cell's front: formulas that none of the others beats in both training error and complexity,
// by increasing complexity; the chosen one is always among them, with what `judged`, the cell's
// record, says of its singularity: it is not proved again. With weights of the training rows, the
// weighted error stands for the training error.
std::vector<FrontRecord> judge_front(const Problem& problem, const std::vector<Expression>& front,
                                     std::size_t chosen, const Record& judged,
                                     std::span<const double> weights = {});

}  // namespace tribench
