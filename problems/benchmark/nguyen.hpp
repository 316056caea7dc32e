// SPDX-License-Identifier: MIT
//
// The twelve Nguyen problems: 20 noise-free rows, 100 for the test.
// Source: Uy, Hoai, O'Neill, McKay, Galvan-Lopez 2011.
#pragma once

#include <vector>

#include "problems/problem.hpp"

namespace tribench::benchmark {

void add_nguyen_entries(std::vector<ProblemEntry>& entries);

}  // namespace tribench::benchmark
