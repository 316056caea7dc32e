// SPDX-License-Identifier: MIT
//
// What can be said of a family while effects are looked for: what else it could be, why it cannot
// be tested.
#pragma once

#include <cstddef>
#include <string>

namespace tribench::loop {

struct AliasFinding {
  std::string family;
  double correlation = 0;
  double gain_difference = 0;
  double error = 0;
  bool exact = false;
  std::string separate_by;
};

struct UntestableFinding {
  std::string family;
  std::string reason;
  double share = 0;
  std::size_t clusters = 0;
  std::string ask;
};

}  // namespace tribench::loop
