// SPDX-License-Identifier: MIT
//
// Friction laws for comparing methods with figures elsewhere (suites of other problems:
// problems/suite):
//   peer/friction1d, peer/load4d     two friction laws on which other programs' figures are known,
//                                    with noise of our own for each seed
//   peer_problems/friction1d, ...    the same with the very rows the others were given, from
//                                    <data>/peer_problems/*_train.csv
// Test rows are noise-free: mae_test is the error against the law.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "problems/problem.hpp"

namespace tribench::benchmark {

void add_entries(std::vector<ProblemEntry>& entries,
                 const std::optional<std::filesystem::path>& data);

}  // namespace tribench::benchmark
