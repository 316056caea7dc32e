// SPDX-License-Identifier: MIT
//
// One shape for several categories (joints, machines, materials), with constants of each one's own:
// many joints, one law. By any method. Candidates are what it finds on all rows together, where the
// target of each category is divided by its size, and on each category alone; the constants of
// every candidate are fitted to each category, those that enter linearly solved for
// (fitting/constant_fit.hpp). The shape with the most evidence of all categories together stands:
// nodes are paid for once, numbers in each, and of rows whose errors are alike fewer count.
//
// Not for categories with laws of different shape: what each one's own formula is beside the shared
// one says whether they are. Not for formulas with a memory.
//
// Source: parametric expressions of PySR (Cranmer 2023), there inside the search.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/run_cell.hpp"

namespace tribench {

struct CategoryResult {
  double category = 0;
  std::vector<double> constants;  // in the order of the shape
  Record record;                  // of the shape with these constants
  Record own;                     // of the formula found for this category alone
};

struct CategoryFit {
  FailureReason failure;                   // none where there is a shape
  std::string shape;                       // p1(), p2() ... : constants of each category's own
  int complexity = 0;                      // of the shape
  std::vector<CategoryResult> categories;  // by increasing value
  std::uint64_t evaluations = 0;           // of all searches
  double fit_cpu_s = 0;                    // of all searches and fits, their programs included
  double peak_memory_mib = 0;              // of the search that took most
  bool was_ended_by_clock = false;
};

// Which category each row of the training and the test table belongs to: any numbers.
struct CategoryColumn {
  std::string name;
  std::vector<double> train;
  std::vector<double> test;
};

// What travels with the rows as the last input, and no method sees, taken out again.
CategoryColumn take_last_input(Problem& problem);

// `problem` has one stage and no states. Each search may spend an equal share of the task's limits;
// categories that the seconds do not reach have no formula of their own.
// Throws Error (bad_input) with fewer than two categories, fewer than ten rows in one, and test
// rows of one that has no others.
CategoryFit fit_by_category(const Problem& problem, const CategoryColumn& column,
                            const Regressor& method, const CellTask& task,
                            const WidenedMethod& widened = {});

// The same as a cell of a grid. Errors are those over the rows of all categories, complexity is the
// shape's, and of the judgements the worst of any category stands. The formula is the shape with
// the constants behind it, "p1()*v; joint=1: p1()=14.2; joint=2: p1()=0.3", and the front has that
// one alone. Where the fit throws, or no shape is found, the record has failed.
CellResult fit_and_judge_by_category(const Problem& problem, const CategoryColumn& column,
                                     const Regressor& method, const CellTask& task,
                                     const WidenedMethod& widened = {});

// Whether a record's formula is a shape with constants behind it.
bool has_categories(std::string_view formula);

}  // namespace tribench
