// SPDX-License-Identifier: MIT
//
// The machine as far as times depend on it. Unknown facts are empty or 0. Not for deciding what is
// computed: results depend on none of it.
#pragma once

#include <string>

namespace tribench {

struct Machine {
  std::string host;
  std::string system;    // kernel and release
  std::string cpu;       // model name
  int processors = 0;    // that this process may use
  std::string governor;  // of the first processor
  double memory_mib = 0;
};

Machine describe_machine();

// Processors that this process may use; at least 1.
int usable_processors();

}  // namespace tribench
