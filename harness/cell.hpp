// SPDX-License-Identifier: MIT
//
// One cell of a grid: problem x method x operator set x seed. Its key names it everywhere: random
// stream, journal, report; nothing else builds a name for a cell.
#pragma once

#include <cstdint>
#include <string>

namespace tribench {

// The operator set of a method with a fixed form, which runs once per problem and seed.
inline constexpr const char* kFixedForm = "-";

struct Cell {
  std::string problem;
  std::string method;
  std::string operators;
  std::uint64_t seed = 0;
  std::string data = {};  // hash of a user problem's files; empty for those of the catalogue

  std::string key() const;  // "A/j2/load|pysr|paper|1", "mine@3fa9c1e2d4b5|pysr|paper|1"
  bool operator==(const Cell&) const = default;
};

}  // namespace tribench
