// SPDX-License-Identifier: MIT
//
// What the loop's models are worth in motion: the recording run again with the model before and the
// one after, half a second ahead from where the joint was measured, over and over.
//
// Where the target is a motor's torque less a declared gravity, that gravity stays as recorded;
// else the formula is the whole torque. The inertia is the formula's own where it reads the
// acceleration, else it is fitted to the training movements.
#pragma once

#include <string>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "problems/dataset.hpp"
#include "problems/reading/csv.hpp"
#include "reports/record/loop_record.hpp"

namespace tribench::loop {

// What positions were written in, to speak of errors in.
struct PositionUnit {
  std::string name;
  double si = 1;
};
PositionUnit position_unit(const DataFile& file);

// data: what was diagnosed, of `recording`. All figures are missing where there is no motor torque,
// no position or time, or a model has no motion.
LoopMotion loop_motion(const Diagnosis& diagnosis, const Observations& data, Dataset recording,
                       const PositionUnit& unit);

}  // namespace tribench::loop
