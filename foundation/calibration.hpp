// SPDX-License-Identifier: MIT
//
// A fixed piece of arithmetic, timed before, during and after a run: whether the machine kept its
// pace decides whether the run's times can be compared with another run's.
#pragma once

#include <vector>

namespace tribench {

struct CalibrationSample {
  double at_s = 0;    // since the run's start
  double cpu_s = 0;   // the least CPU time of a few rounds
  double wall_s = 0;  // of the same round
};

// About 5 ms of double-precision arithmetic in one thread. The sample's at_s is left to the
// caller.
CalibrationSample calibrate();

// Largest over smallest CPU time, less one; 0 for fewer than two samples.
double calibration_drift(const std::vector<CalibrationSample>& samples);

}  // namespace tribench
