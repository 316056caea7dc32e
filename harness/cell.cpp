// SPDX-License-Identifier: MIT
#include "harness/cell.hpp"

#include <fmt/format.h>

#include <string_view>

namespace tribench {

std::string Cell::key() const {
  const std::string_view at = data.empty() ? "" : "@";
  return fmt::format("{}{}{}|{}|{}|{}", problem, at, data, method, operators, seed);
}

}  // namespace tribench
