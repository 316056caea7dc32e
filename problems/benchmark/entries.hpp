// SPDX-License-Identifier: MIT
//
// Published test problems of symbolic regression, for comparing methods with figures elsewhere:
//   nguyen/1 ... nguyen/12           Uy et al. 2011, as used by Petersen et al. 2021, table 6
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
