// SPDX-License-Identifier: MIT
#include "algorithms/fitting/ipopt_minimizer.hpp"

#include <IpStdCInterface.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

namespace tribench {
namespace {

constexpr double kInfinity = 2e19;  // what Ipopt takes for "no bound"
constexpr double kFeasible = 1e-8;

struct FreeIpopt {
  void operator()(IpoptProblemInfo* problem) const { FreeIpoptProblem(problem); }
};
using OwnedIpopt = std::unique_ptr<IpoptProblemInfo, FreeIpopt>;

struct IpoptCall {
  const Objective& objective;
  const Bounds& bounds;
  const Constraints& constraints;
  const MinimizeOptions& options;
  std::vector<double> values = std::vector<double>(constraints.low.size());
  std::vector<double> point = {};
  Minimum best = {};

  bool feasible(std::span<const double> x) {
    if (!constraints.evaluate) return true;
    constraints.evaluate(x, values, {});
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(values[i] >= constraints.low[i] - kFeasible &&
            values[i] <= constraints.high[i] + kFeasible)) {
        return false;
      }
    }
    return true;
  }

  // Ipopt's points may lie outside the bounds by rounding: the objective sees them inside.
  double value(std::span<const double> x, std::span<double> gradient) {
    best.evaluations += 1;
    point.assign(x.begin(), x.end());
    for (std::size_t i = 0; i < bounds.low.size(); ++i)
      point[i] = std::max(point[i], bounds.low[i]);
    for (std::size_t i = 0; i < bounds.high.size(); ++i)
      point[i] = std::min(point[i], bounds.high[i]);
    const double result = objective(point, gradient);
    if (std::isfinite(result) && result < best.value && feasible(point)) {
      best.value = result;
      best.x = point;
    }
    return result;
  }
};

Bool eval_f(Index n, Number* x, Bool /*new_x*/, Number* value, UserDataPtr call) {
  *value = static_cast<IpoptCall*>(call)->value({x, static_cast<std::size_t>(n)}, {});
  return std::isfinite(*value) ? TRUE : FALSE;
}

Bool eval_grad_f(Index n, Number* x, Bool /*new_x*/, Number* gradient, UserDataPtr call) {
  const auto size = static_cast<std::size_t>(n);
  static_cast<IpoptCall*>(call)->value({x, size}, {gradient, size});
  return std::all_of(gradient, gradient + n, [](double g) { return std::isfinite(g); }) ? TRUE
                                                                                        : FALSE;
}

Bool eval_g(Index n, Number* x, Bool /*new_x*/, Index m, Number* values, UserDataPtr call) {
  const auto& constraints = static_cast<IpoptCall*>(call)->constraints;
  if (m == 0) return TRUE;
  constraints.evaluate({x, static_cast<std::size_t>(n)}, {values, static_cast<std::size_t>(m)}, {});
  return TRUE;
}

// The pattern is dense.
Bool eval_jac_g(Index n, Number* x, Bool /*new_x*/, Index m, Index entries, Index* row,
                Index* column, Number* values, UserDataPtr call) {
  if (values == nullptr) {
    for (Index k = 0; k < entries; ++k) {
      row[k] = k / n;
      column[k] = k % n;
    }
    return TRUE;
  }
  if (m == 0) return TRUE;
  IpoptCall& state = *static_cast<IpoptCall*>(call);
  state.constraints.evaluate({x, static_cast<std::size_t>(n)}, state.values,
                             {values, static_cast<std::size_t>(entries)});
  return TRUE;
}

Bool eval_h(Index, Number*, Bool, Number, Index, Number*, Bool, Index, Index*, Index*, Number*,
            UserDataPtr) {
  return FALSE;  // curvature is approximated
}

Bool after_iteration(Index, Index, Number, Number, Number, Number, Number, Number, Number, Number,
                     Index, UserDataPtr call) {
  const IpoptCall& state = *static_cast<IpoptCall*>(call);
  const bool stopped = state.options.stop != nullptr && *state.options.stop;
  return stopped || state.best.evaluations >= state.options.max_evaluations ? FALSE : TRUE;
}

std::vector<double> ipopt_bounds(const std::vector<double>& given, std::size_t n, double none) {
  std::vector<double> result(n, none);
  for (std::size_t i = 0; i < given.size(); ++i) {
    result[i] = std::clamp(given[i], -kInfinity, kInfinity);
  }
  return result;
}

void set_options(IpoptProblemInfo* problem, const MinimizeOptions& options) {
  const auto text = [&](const char* key, const char* value) {
    AddIpoptStrOption(problem, const_cast<char*>(key), const_cast<char*>(value));
  };
  text("sb", "yes");
  text("hessian_approximation", "limited-memory");
  text("honor_original_bounds", "yes");
  // Its default widens the bounds a little, and the best point would lie outside them.
  AddIpoptNumOption(problem, const_cast<char*>("bound_relax_factor"), 0);
  AddIpoptIntOption(problem, const_cast<char*>("print_level"), 0);
  AddIpoptIntOption(problem, const_cast<char*>("max_iter"),
                    static_cast<int>(std::min<std::uint64_t>(options.max_evaluations, 1'000'000)));
  AddIpoptNumOption(problem, const_cast<char*>("tol"), std::max(options.value_tolerance, 1e-12));
}

}  // namespace

Minimum minimize_ipopt(const Objective& objective, std::span<const double> start,
                       const Bounds& bounds, const Constraints& constraints,
                       const MinimizeOptions& options) {
  // One solve at a time in a process: the linear solver keeps global state.
  static std::mutex one_solve;
  const std::lock_guard<std::mutex> lock(one_solve);
  const std::size_t n = start.size();
  const std::size_t m = constraints.low.size();
  IpoptCall call{objective, bounds, constraints, options};
  std::vector<double> low = ipopt_bounds(bounds.low, n, -kInfinity);
  std::vector<double> high = ipopt_bounds(bounds.high, n, kInfinity);
  std::vector<double> constraint_low = ipopt_bounds(constraints.low, m, -kInfinity);
  std::vector<double> constraint_high = ipopt_bounds(constraints.high, m, kInfinity);
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = std::clamp(start[i], low[i], high[i]);
  call.best.x = x;
  call.value(x, {});  // an interior-point method moves off the start: keep it if it is best
  const OwnedIpopt problem(CreateIpoptProblem(static_cast<Index>(n), low.data(), high.data(),
                                              static_cast<Index>(m), constraint_low.data(),
                                              constraint_high.data(), static_cast<Index>(n * m), 0,
                                              0, eval_f, eval_g, eval_grad_f, eval_jac_g, eval_h));
  if (!problem) return call.best;
  set_options(problem.get(), options);
  SetIntermediateCallback(problem.get(), after_iteration);
  double value = 0;
  const ApplicationReturnStatus status =
      IpoptSolve(problem.get(), x.data(), nullptr, &value, nullptr, nullptr, nullptr, &call);
  const bool converged = status == Solve_Succeeded || status == Solved_To_Acceptable_Level;
  const bool limit = status == Maximum_Iterations_Exceeded || status == User_Requested_Stop;
  call.best.status = converged ? MinimizeStatus::converged
                     : limit   ? MinimizeStatus::limit
                               : MinimizeStatus::failed;
  return call.best;
}

}  // namespace tribench
