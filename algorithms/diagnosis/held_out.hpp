// SPDX-License-Identifier: MIT
//
// The movements nobody touches: which they are, and what the models make of them.
// Internal to the room.
#pragma once

#include <span>
#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

// share of the movements, spread over speeds; at least one, and none where fewer than two movements
// would be left. However the recording is told, they are the same.
std::vector<int> choose_test_movements(const Observations& data, double share);

// Errors of both models on `data` (the test movements), movement by movement, with a bootstrap
// interval of the paired difference. unit: per row, what the bootstrap draws (movements, or pieces
// of them where they are few); equal numbers stand together.
ErrorFinding judge(const Observations& data, const Eigen::VectorXd& before,
                   const Eigen::VectorXd& after, std::span<const int> unit, RandomStream random);

}  // namespace tribench::loop
