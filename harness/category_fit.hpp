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
// one says whether they are. Not for grids.
//
// Source: parametric expressions of PySR (Cranmer 2023), there inside the search.
#pragma once

#include <cstdint>
#include <span>
#include <string>
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
  std::string shape;                       // p1(), p2() ... : constants of each category's own
  int complexity = 0;                      // of the shape
  std::vector<CategoryResult> categories;  // by increasing value
  std::uint64_t evaluations = 0;           // of all searches
  double fit_cpu_s = 0;                    // of all searches and fits
  bool was_ended_by_clock = false;
};

// Which category each row of the training and the test table belongs to: any numbers.
struct CategoryColumn {
  std::vector<double> train;
  std::vector<double> test;
};

// `problem` has one stage and no states. Each search may spend an equal share of the task's limits.
// Throws Error (bad_input) with fewer than two categories or fewer than ten rows in one, and Error
// (failed) where no formula is found.
CategoryFit fit_by_category(const Problem& problem, const CategoryColumn& column,
                            const Regressor& method, const CellTask& task,
                            const WidenedMethod& widened = {});

}  // namespace tribench
