// SPDX-License-Identifier: MIT
//
// What is noise, before anything is known of what is missing. Internal to the room.
#pragma once

#include <vector>

#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

// Residual of every row under the richest model there is (base and all effects, a small ridge),
// fitted to the training rows: what is left is noise and events, so it says how long noise lasts.
Eigen::VectorXd rich_residual(const Observations& data, const std::vector<char>& train_rows,
                              const BaseModel& base, const std::vector<EffectFamily>& families,
                              const DiagnosisOptions& options);

}  // namespace tribench::loop
