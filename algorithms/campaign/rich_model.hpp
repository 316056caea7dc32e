// SPDX-License-Identifier: MIT
//
// What is noise, before anything is known of what is missing.
#pragma once

#include <vector>

#include "algorithms/campaign/options.hpp"
#include "algorithms/loop_model/loop_model.hpp"

namespace tribench::loop {

// The base's linear terms and the library, without what differs by direction or stands beside
// another. Neighbours on a grid of shapes say nearly the same: some of them will do.
Eigen::MatrixXd rich_columns(const Observations& data, const BaseModel& base,
                             const std::vector<EffectFamily>& families,
                             const std::vector<double>& gear_ratios);

// Residual of every row under the richest model there is (base and all effects, a small ridge),
// fitted to the training rows: what is left is noise and events, so it says how long noise lasts.
Eigen::VectorXd rich_residual(const Observations& data, const std::vector<char>& train_rows,
                              const BaseModel& base, const std::vector<EffectFamily>& families,
                              const DiagnosisOptions& options);

}  // namespace tribench::loop
