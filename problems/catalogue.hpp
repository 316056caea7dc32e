// SPDX-License-Identifier: MIT
//
// Every problem by name: the one list that the grid, the command line and the tests read.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "problems/problem.hpp"
#include "problems/suite/suite_problem.hpp"
#include "problems/user/user_problem.hpp"

namespace tribench {

class Catalogue {
 public:
  // data: the folder with the measured sets (--data, $TRIBENCH_DATA or ./data); measured problems
  // are listed without it too, but can be made only with it.
  // laws: makes rows of the suites' laws; without it those problems are listed and cannot be made.
  // own: problems that a grid brings itself.
  explicit Catalogue(std::optional<std::filesystem::path> data = std::nullopt,
                     const suite::LawReader& laws = {},
                     std::span<const user::UserProblem> own = {});

  const std::vector<ProblemEntry>& entries() const { return entries_; }
  const std::vector<suite::Suite>& suites() const { return suites_; }
  // Also NAME~noise=0.1 (variant.hpp). Throws Error (bad_input) with the nearest name.
  ProblemEntry find(std::string_view name) const;

 private:
  std::vector<ProblemEntry> entries_;
  std::vector<suite::Suite> suites_;
};

}  // namespace tribench
