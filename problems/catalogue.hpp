// SPDX-License-Identifier: MIT
//
// Every problem by name: the one list that the grid, the command line and the tests read.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "problems/problem.hpp"

namespace tribench {

class Catalogue {
 public:
  // data: the folder with the measured sets (--data, $TRIBENCH_DATA or ./data); measured problems
  // are listed without it too, but can be made only with it.
  explicit Catalogue(std::optional<std::filesystem::path> data = std::nullopt);

  const std::vector<ProblemEntry>& entries() const { return entries_; }
  // Throws Error (bad_input) with the nearest name.
  const ProblemEntry& find(std::string_view name) const;

 private:
  std::vector<ProblemEntry> entries_;
};

}  // namespace tribench
