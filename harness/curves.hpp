// SPDX-License-Identifier: MIT
//
// The points of a run's pictures: what each method's formula predicts, beside the measured rows
// and the true law. Of the seeds of a method and operator set the one with the median test error
// is drawn.
//
// Pictures: "friction" over velocity (at three gravity torques where there is one; other inputs at
// their median), "error" of the test rows over velocity, and for datasets A and B "profile", the
// torque along a sinusoidal velocity. Values that are not finite are left out.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/cell_task.hpp"
#include "problems/catalogue.hpp"
#include "reports/record/record.hpp"

namespace tribench {

// A problem whose data are not here gives no curves. About 300 points a method and problem.
std::vector<CurveRecord> sample_curves(const std::vector<Record>& records,
                                       const Catalogue& catalogue);

// Writes curves.csv.
void write_curves(const std::filesystem::path& folder, const std::vector<CellResult>& results,
                  const Catalogue& catalogue);

}  // namespace tribench
