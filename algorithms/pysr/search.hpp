// SPDX-License-Identifier: MIT
//
// The search: islands in epochs, migration between them, the front at the end.
//
// Ours differs from the original's asynchronous islands in that all islands meet after every
// epoch, in their order: the result does not depend on the number of threads, and deadlines and
// budgets are kept inside the islands.
#pragma once

#include "algorithms/pysr/options.hpp"
#include "algorithms/regressor.hpp"

namespace tribench::pysr {

FitResult search(const Options& options, FitContext& context);

}  // namespace tribench::pysr
