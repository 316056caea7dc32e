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
#include <map>
#include <string>
#include <vector>

#include "harness/cell_task.hpp"
#include "problems/catalogue.hpp"
#include "reports/record/record.hpp"

namespace tribench {

struct Curves {
  std::vector<CurveRecord> points;              // about 300 a method and problem
  std::map<std::string, std::string> not_here;  // problems without data, and why
};
Curves sample_curves(const std::vector<Record>& records, const Catalogue& catalogue);

// Writes curves.csv. Of a problem whose data are not here it keeps the points that the file had.
// Returns what to tell the user of these, a line each.
std::vector<std::string> write_curves(const std::filesystem::path& folder,
                                      const std::vector<CellResult>& results,
                                      const Catalogue& catalogue);

}  // namespace tribench
