// SPDX-License-Identifier: MIT
//
// Searches the inner parameters of one family for its best model: many starts of
// Levenberg-Marquardt on the projected problem, or one of the general global optimisers on the
// same objective, for comparison. What a guard is there for is kept by every one of them.
#pragma once

#include <optional>
#include <string_view>

#include "algorithms/fitting/nlopt_minimizer.hpp"
#include "algorithms/parfam/formula.hpp"
#include "algorithms/parfam/pole_guard.hpp"
#include "foundation/random.hpp"

namespace tribench::parfam {

enum class Optimizer { multi_start, basin_hopping, mlsl, crs2, esch, isres, direct_l, ipopt };

// "multi_start", "basin_hopping", ...; the name must be one of them.
Optimizer find_optimizer(std::string_view name);

// NLopt's name for a global optimiser; not for multi_start, basin_hopping and ipopt.
NloptMethod nlopt_method(Optimizer optimizer);

struct InnerSearchOptions {
  Optimizer optimizer = Optimizer::multi_start;
  int starts = 16;         // or basin hopping's iterations
  int agreements = 3;      // starts end when so many reached the same least value
  int evaluations = 4000;  // of a global optimiser
  Denominators denominators = Denominators::safe;
  const PoleGuard* guard = nullptr;  // with constrained denominators
};

// inputs: scaled to about [-1, 1], so that parameters of order 1 are the right size. Nothing where
// no start was finite or the budget was spent before the first.
std::optional<TrainedModel> search_family(const Structure& structure,
                                          std::span<const double* const> inputs,
                                          std::span<const double> y,
                                          const InnerSearchOptions& options, Budget& budget,
                                          const RandomStream& random);

}  // namespace tribench::parfam
