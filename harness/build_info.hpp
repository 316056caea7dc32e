// SPDX-License-Identifier: MIT
//
// What this program was built from and with; filled in by the build.
#pragma once

#include <string>

namespace tribench {

struct BuildInfo {
  std::string version;    // "0.1.0"
  std::string commit;     // short hash, or "unknown" outside a repository
  bool is_dirty = false;  // tracked files differed from the commit
  std::string compiler;   // "GNU 12.2.0"
  std::string flags;
  std::string build_type;
};

BuildInfo build_info();

}  // namespace tribench
