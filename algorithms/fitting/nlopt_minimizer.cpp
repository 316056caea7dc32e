// SPDX-License-Identifier: MIT
#include "algorithms/fitting/nlopt_minimizer.hpp"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "foundation/error.hpp"

namespace tribench {
namespace {

// Vectors kept by L-BFGS; more than a handful of constants never need more.
constexpr unsigned kStoredVectors = 10;
// Share of a global method's evaluations that MLSL may give to one local search.
constexpr int kLocalEvaluationsPerParameter = 100;

struct FreeNlopt {
  void operator()(nlopt_opt_s* problem) const { nlopt_destroy(problem); }
};
using OwnedNlopt = std::unique_ptr<nlopt_opt_s, FreeNlopt>;

nlopt_algorithm algorithm_of(NloptMethod method) {
  switch (method) {
    case NloptMethod::lbfgs:
      return NLOPT_LD_LBFGS;
    case NloptMethod::slsqp:
      return NLOPT_LD_SLSQP;
    case NloptMethod::truncated_newton:
      return NLOPT_LD_TNEWTON_PRECOND_RESTART;
    case NloptMethod::mlsl:
      return NLOPT_GD_MLSL_LDS;
    case NloptMethod::crs2:
      return NLOPT_GN_CRS2_LM;
    case NloptMethod::esch:
      return NLOPT_GN_ESCH;
    case NloptMethod::isres:
      return NLOPT_GN_ISRES;
    default:
      return NLOPT_GN_DIRECT_L;
  }
}

// What the library's callback sees; keeps the best point, because NLopt may return another.
struct NloptCall {
  const Objective& objective;
  const bool* stop;
  nlopt_opt problem;
  Minimum best;

  double operator()(unsigned n, const double* x, double* gradient) {
    const std::span<double> wanted(gradient, gradient == nullptr ? 0 : n);
    if (stop != nullptr && *stop) {
      // A line search goes on for a few points before it looks at the flag.
      nlopt_force_stop(problem);
      std::ranges::fill(wanted, 0.0);
      return HUGE_VAL;
    }
    best.evaluations += 1;
    const double value = objective({x, n}, wanted);
    if (std::isfinite(value) && value < best.value) {
      best.value = value;
      best.x.assign(x, x + n);
    }
    if (std::isfinite(value) &&
        std::ranges::all_of(wanted, [](double g) { return std::isfinite(g); })) {
      return value;
    }
    // NLopt has no word for "undefined here": a wall makes line searches turn back.
    std::ranges::fill(wanted, 0.0);
    return HUGE_VAL;
  }
};

double evaluate(unsigned n, const double* x, double* gradient, void* call) {
  return (*static_cast<NloptCall*>(call))(n, x, gradient);
}

void check_bounds(NloptMethod method, const Bounds& bounds, std::size_t n) {
  if (!is_global(method)) return;
  const auto finite = [](double value) { return std::isfinite(value); };
  if (bounds.low.size() == n && bounds.high.size() == n &&
      std::ranges::all_of(bounds.low, finite) && std::ranges::all_of(bounds.high, finite)) {
    return;
  }
  throw Error(ErrorKind::failed,
              fmt::format("the global minimiser '{}' needs finite bounds on all {} parameters",
                          nlopt_method_name(method), n));
}

void set_tolerances(nlopt_opt problem, const MinimizeOptions& options) {
  nlopt_set_ftol_rel(problem, options.value_tolerance);
  nlopt_set_xtol_rel(problem, options.position_tolerance);
}

}  // namespace

std::string_view nlopt_method_name(NloptMethod method) {
  static constexpr std::string_view kNames[] = {
      "lbfgs", "slsqp", "truncated_newton", "mlsl", "crs2", "esch", "isres", "direct_l"};
  return kNames[static_cast<std::size_t>(method)];
}

bool is_global(NloptMethod method) { return method >= NloptMethod::mlsl; }

Minimum minimize_nlopt(NloptMethod method, const Objective& objective,
                       std::span<const double> start, const Bounds& bounds,
                       const MinimizeOptions& options) {
  const auto n = static_cast<unsigned>(start.size());
  check_bounds(method, bounds, start.size());
  const OwnedNlopt problem(nlopt_create(algorithm_of(method), n));
  NloptCall call{objective, options.stop, problem.get(), {}};
  call.best.x.assign(start.begin(), start.end());
  nlopt_set_min_objective(problem.get(), evaluate, &call);
  if (!bounds.low.empty()) nlopt_set_lower_bounds(problem.get(), bounds.low.data());
  if (!bounds.high.empty()) nlopt_set_upper_bounds(problem.get(), bounds.high.data());
  nlopt_set_maxeval(problem.get(), static_cast<int>(std::min<std::uint64_t>(options.max_evaluations,
                                                                            1'000'000'000)));
  nlopt_set_vector_storage(problem.get(), kStoredVectors);
  if (is_global(method)) {
    // A global search ends by its evaluations; tolerances are for its local searches.
    const OwnedNlopt local(nlopt_create(NLOPT_LD_LBFGS, n));
    set_tolerances(local.get(), options);
    nlopt_set_maxeval(local.get(), kLocalEvaluationsPerParameter * static_cast<int>(n));
    nlopt_set_local_optimizer(problem.get(), local.get());
  } else {
    set_tolerances(problem.get(), options);
  }
  nlopt_srand(static_cast<unsigned long>(options.seed));
  std::vector<double> x(start.begin(), start.end());
  for (unsigned i = 0; i < n && !bounds.low.empty(); ++i) x[i] = std::max(x[i], bounds.low[i]);
  for (unsigned i = 0; i < n && !bounds.high.empty(); ++i) x[i] = std::min(x[i], bounds.high[i]);
  double value = 0;
  const nlopt_result result = nlopt_optimize(problem.get(), x.data(), &value);
  const bool limit = result == NLOPT_MAXEVAL_REACHED || result == NLOPT_FORCED_STOP ||
                     (options.stop != nullptr && *options.stop);
  call.best.status = limit        ? MinimizeStatus::limit
                     : result > 0 ? MinimizeStatus::converged
                                  : MinimizeStatus::failed;
  return call.best;
}

}  // namespace tribench
