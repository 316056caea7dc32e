// SPDX-License-Identifier: MIT
//
// A simulated motion for people: on the terminal, as JSON, and as a page with a picture a movement
// that opens without a network.
#pragma once

#include <string>

#include "reports/record/motion_record.hpp"

namespace tribench {

std::string motion_terminal(const MotionRecord& record);

// {"unit", "formula", "inertia", "gravity", ..., "held_out": {"mean_position", ...}, "training",
//  "movements": [{"name", "held_out", "status", ...}], "fit", "notes"}
std::string write_motion_json(const MotionRecord& record);

// movement,time_s,measured,simulated: the traces.
std::string motion_csv(const MotionRecord& record);

std::string motion_html(const MotionRecord& record);

}  // namespace tribench
