// SPDX-License-Identifier: MIT
//
// Ipopt behind the common objective, with bounds and general constraints. Source: Waechter &
// Biegler 2006. Curvature is approximated (limited memory), so only first derivatives are needed.
//
// Ipopt 3.11.9 with MUMPS is not thread-safe: solves from several threads of a process wait for
// one another here.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "algorithms/fitting/objective.hpp"

namespace tribench {

// low[i] <= c_i(x) <= high[i]. `evaluate` writes the values and, where asked for (jacobian not
// empty), the derivatives: jacobian[i * n + j] = dc_i / dx_j.
struct Constraints {
  std::vector<double> low;
  std::vector<double> high;
  std::function<void(std::span<const double> x, std::span<double> values,
                     std::span<double> jacobian)>
      evaluate;
};

// A local minimum that keeps to bounds and constraints to 1e-8. The best feasible point seen,
// the start (moved into the bounds) where none was.
Minimum minimize_ipopt(const Objective& objective, std::span<const double> start,
                       const Bounds& bounds = {}, const Constraints& constraints = {},
                       const MinimizeOptions& options = {});

}  // namespace tribench
