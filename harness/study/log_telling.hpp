// SPDX-License-Identifier: MIT
//
// What sensors and a logger make of a joint's run: encoder counts, a filtered velocity, a current,
// stamps with jitter, lost and repeated messages; in some unit, some layout of a text file, under
// some names. Every telling can be read by who knows what its engineer knows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "foundation/random.hpp"
#include "problems/joint_simulation/controlled_run.hpp"
#include "problems/preparation/data_options.hpp"

namespace tribench {

// Whether the file's header says what its columns are, or the user.
enum class LogKnowledge {
  bare,  // names and units in the header, nothing else is said
  told,  // roles, units, torque constant, gear ratio, counts of a turn
};

struct ToldLog {
  std::string text;
  DataOptions known;                 // what is said beside the file
  std::vector<std::string> options;  // the same as words of the command line
  double torque_scale = 1;  // of the torque's channel once it is read, in N m (N): A without a
                            // constant
  std::string summary;      // "2^14 counts, velocity [deg/s], current [mA], ROS stamps"
};

// encoder_bits: the position alone, from an encoder of so many counts at the joint; else drawn,
// with or without a velocity.
ToldLog tell_log(const simulation::ControlledRun& run, LogKnowledge knowledge, RandomStream random,
                 std::optional<int> encoder_bits = {});

}  // namespace tribench
