// SPDX-License-Identifier: MIT
//
// What a method answers that cannot do without an input whose role nobody has said, and how a user
// says it: the same for every method, told where the whole fit fails by it.
#pragma once

#include <string>

#include "algorithms/regressor.hpp"

namespace tribench {

inline constexpr const char* kWithRole = " with role ";

// needs: who needs what, such as "friction from load needs an input"; role: its name in `roles`.
inline FitResult unsupported_without_role(const std::string& needs, const std::string& role) {
  return FitResult::unsupported(needs + kWithRole + role);
}

// `note`, with the mend where it ends as above.
inline std::string with_mend_of_role(const std::string& note) {
  const std::size_t at = note.rfind(kWithRole);
  if (at == std::string::npos) return note;
  const std::string role = note.substr(at + std::string(kWithRole).size());
  if (role.empty() || role.find(' ') != std::string::npos) return note;
  return note + "; of a file of your own say which column it is: roles = \"COLUMN=" + role +
         "\" in its [[problem]], or --roles COLUMN=" + role;
}

}  // namespace tribench
