// SPDX-License-Identifier: MIT
#include "algorithms/model_based/coulomb_viscous.hpp"

#include <optional>

#include "algorithms/fitting/linear_least_squares.hpp"

namespace tribench {
namespace {

// Bit b of `without`: branch b has no Coulomb friction. Nothing where a Coulomb level is negative.
struct Solution {
  StribeckModel model;
  double sum_squares = 0;
};

std::optional<Solution> solve(const StribeckRows& rows, StribeckModel model, unsigned without) {
  std::vector<std::vector<double>> columns;
  std::vector<double*> coefficients;
  const auto add_of_branch = [&](std::size_t branch, const std::vector<double>& values,
                                 double& coefficient) {
    std::vector<double> column(values);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (rows.branch[r] != branch) column[r] = 0;
    }
    columns.push_back(std::move(column));
    coefficients.push_back(&coefficient);
  };
  for (std::size_t b = 0; b < model.branches.size(); ++b) {
    StribeckBranch& branch = model.branches[b];
    branch.coulomb = 0;
    branch.breakaway_excess = 0;
    if (((without >> b) & 1U) == 0) add_of_branch(b, rows.sign, branch.coulomb);
    add_of_branch(b, rows.velocity, branch.viscous);
  }
  if (model.has_offset) {
    columns.emplace_back(rows.size(), 1.0);
    coefficients.push_back(&model.offset);
  }
  if (model.has_inertia) {
    columns.push_back(rows.acceleration);
    coefficients.push_back(&model.inertia);
  }
  std::vector<const double*> pointers;
  for (const std::vector<double>& column : columns) pointers.push_back(column.data());
  const LinearFit fit = solve_least_squares(pointers, rows.target);
  for (std::size_t k = 0; k < coefficients.size(); ++k) *coefficients[k] = fit.coefficients[k];
  for (const StribeckBranch& branch : model.branches) {
    if (branch.coulomb < 0) return std::nullopt;
  }
  return Solution{std::move(model), fit.sum_squares};
}

}  // namespace

StribeckFit fit_coulomb_viscous(const StribeckRows& rows, StribeckModel& model, Budget& budget) {
  const std::uint64_t terms = model.parameter_count();
  std::optional<Solution> best;
  for (unsigned without = 0; without < (1U << model.branches.size()); ++without) {
    if (best && without == 1) break;  // the free minimum is feasible
    if (!budget.spend(terms * terms * rows.size())) break;
    std::optional<Solution> found = solve(rows, model, without);
    if (found && (!best || found->sum_squares < best->sum_squares)) best = std::move(found);
  }
  StribeckFit fit;
  fit.out_of_budget = budget.exhausted();
  if (best) {
    model = std::move(best->model);
    fit.sum_squares = best->sum_squares;
  }
  return fit;
}

}  // namespace tribench
