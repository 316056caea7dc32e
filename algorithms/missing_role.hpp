// SPDX-License-Identifier: MIT
//
// What a method answers that cannot do without an input whose role nobody has said. The mend is the
// same for every method, so it is told here.
#pragma once

#include <string>

#include "algorithms/regressor.hpp"

namespace tribench {

// needs: who needs what, such as "friction from load needs an input"; role: its name in `roles`.
inline FitResult unsupported_without_role(const std::string& needs, const std::string& role) {
  return FitResult::unsupported(
      needs + " with role " + role +
      "; of a file of your own say which column it is: roles = \"COLUMN=" + role +
      "\" in its [[problem]], or --roles COLUMN=" + role);
}

}  // namespace tribench
