// SPDX-License-Identifier: MIT
#include "algorithms/campaign/options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "foundation/error.hpp"

namespace tribench::loop {

void require_enough_flips(const DiagnosisOptions& options) {
  const double level = std::min(options.alpha_library, options.alpha_leftover);
  // A millionth: of a level that has no exact decimal.
  const auto fewest = static_cast<std::size_t>(std::ceil((1 - 1e-6) / level)) - 1;
  if (options.flips >= fewest) return;
  throw_bad_input(fmt::format("{} sign flips reach no level below {:.2g}, and {} is asked for",
                              options.flips, 1 / (1.0 + static_cast<double>(options.flips)), level),
                  "flips", fmt::format("take {} or more, or a higher level", fewest));
}

}  // namespace tribench::loop
