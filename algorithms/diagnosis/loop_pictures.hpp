// SPDX-License-Identifier: MIT
//
// The points behind the loop's pictures: the residual against each channel before and after, the
// fitted effects, the errors by movement and the alias map. The keys are reports/loop_report.hpp's.
#pragma once

#include <nlohmann/json.hpp>

#include "algorithms/diagnosis/diagnosis.hpp"

namespace tribench::loop {

// Rows are thinned evenly to at most 1500.
nlohmann::ordered_json loop_pictures(const Diagnosis& diagnosis, const Observations& data);

}  // namespace tribench::loop
