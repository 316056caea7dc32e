// SPDX-License-Identifier: MIT
//
// Whether the recordings of one campaign count alike: a column in mA in one file and in A in the
// others has one name and one role in all of them. Internal to the room.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"

namespace tribench {

// What one file's numbers say of their units.
struct RecordingScale {
  std::string file;
  std::map<std::string, double> efforts;  // of each torque or current: what nine of ten stay below
  double motion = 0;                      // the same of the velocity, or the range of the position
  std::optional<double> pace;             // the position's change over the velocity's integral
  std::string position;                   // the two columns
  std::string velocity;
};

RecordingScale scale_of(const Dataset& data, std::string_view file);

// Throws Error (bad_input) with the file and the column where one recording's torque or current is
// about a thousand times as large as in two others or more, all of which agree and moved as much,
// or where its position goes with its velocity by another factor, 1000 or 180/pi. Where two
// recordings alone differ so, or one is as much smaller (a drive that was off is, too), it is said:
// one sentence each. Motion that is twenty times as fast in one, or a joint that rests in one, is
// no such case.
std::vector<std::string> check_scales(std::span<const RecordingScale> recordings);

}  // namespace tribench
