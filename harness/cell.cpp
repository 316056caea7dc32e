// SPDX-License-Identifier: MIT
#include "harness/cell.hpp"

#include <fmt/format.h>

namespace tribench {

std::string Cell::key() const {
  return fmt::format("{}|{}|{}|{}", problem, method, operators, seed);
}

}  // namespace tribench
