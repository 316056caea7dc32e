// SPDX-License-Identifier: MIT
#include "harness/grid.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "foundation/error.hpp"
#include "foundation/glob.hpp"

namespace tribench {

OperatorSet fixed_form_operators() {
  std::vector<Op> all;
  for (int op = 0; op < kOpCount; ++op) {
    if (arity(static_cast<Op>(op)) > 0) all.push_back(static_cast<Op>(op));
  }
  return {kFixedForm, "every operation", all};
}

std::vector<Cell> Grid::cells() const {
  std::vector<Cell> all;
  for (const std::string& problem : problems) {
    for (const Method& method : methods) {
      std::vector<std::string> sets;
      if (method.fixed_form) {
        sets = {kFixedForm};
      } else {
        for (const OperatorSet& set : operators) {
          const bool usable =
              !method.is_external() || std::ranges::count(method.operators, set.name()) > 0;
          if (usable) sets.push_back(set.name());
        }
      }
      for (const std::string& set : sets) {
        for (std::uint64_t i = 0; i < seed_count; ++i) {
          all.push_back({problem, method.name, set, first_seed + i});
        }
      }
    }
  }
  return all;
}

const Method& Grid::method(std::string_view method_name) const {
  for (const Method& method : methods) {
    if (method.name == method_name) return method;
  }
  throw Error(ErrorKind::failed, fmt::format("the grid has no method '{}'", method_name));
}

OperatorSet Grid::operator_set(std::string_view set_name) const {
  if (set_name == kFixedForm) {
    return fixed_form_operators();
  }
  for (const OperatorSet& set : operators) {
    if (set.name() == set_name) return set;
  }
  throw Error(ErrorKind::failed, fmt::format("the grid has no operator set '{}'", set_name));
}

bool Grid::quarantined(const std::string& cell_key) const {
  return std::ranges::any_of(quarantine,
                             [&](const std::string& glob) { return glob_matches(glob, cell_key); });
}

}  // namespace tribench
